// The one place that knows all transports.
#include "coordinator/channel/open/channels.h"

#include <utility>
#include <variant>

#include "coordinator/channel/dds/dds_channels.h"
#include "coordinator/channel/pty/pty_channel.h"
#include "coordinator/channel/udp/udp_channel.h"
#include "coordinator/channel/unix/unix_channel.h"

namespace tcs {
namespace {

// A visitor for the alternatives of a variant.
template <class... Cases>
struct Either : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Either(Cases...) -> Either<Cases...>;

}  // namespace

std::string Channels::Open(const Scenario& scenario, dds::OwnEndpoints& ends,
                           const MakeAt& make_at) {
  // The end on UDP that `open` makes, where its address is.
  const auto at = [&make_at](const UdpEndpoint& endpoint, const auto& open) {
    decltype(open()) opened = std::string();
    make_at(endpoint.host, [&] { opened = open(); });
    return opened;
  };
  std::unique_ptr<DdsChannels> dds = DdsChannels::For(scenario, ends);
  auto serial = std::make_unique<PtyChannels>();
  for (const SensorChannelSpec& spec : scenario.sensors) {
    auto outlet =
        std::visit(Either{[&](const UdpEndpoint& to) {
                            return at(to, [&] { return OpenUdpOutlet(to, spec.fields); });
                          },
                          [&](const UnixName& to) { return OpenUnixOutlet(to, spec.fields); },
                          [&](const SerialPort& to) { return serial->OutletOn(to, spec); },
                          [&](const DdsSensorEnd&) { return Opened<Outlet>(dds->OutletOf(spec)); }},
                   spec.to);
    if (auto* error = std::get_if<std::string>(&outlet)) return std::move(*error);
    outlets.push_back(std::move(std::get<std::unique_ptr<Outlet>>(outlet)));
  }
  std::unique_ptr<Inlet> dds_commands = dds == nullptr ? nullptr : dds->Commands();
  for (std::size_t i = 0; i < scenario.commands.size(); ++i) {
    auto inlet = std::visit(
        Either{[&](const UdpEndpoint& from) {
                 return at(from, [&] { return OpenUdpInlet(from, i); });
               },
               [i](const UnixName& from) { return OpenUnixInlet(from, i); },
               [&](const SerialPort& from) { return serial->InletOn(from, i); },
               [](const DdsCommandEnd&) { return Opened<Inlet>(std::unique_ptr<Inlet>()); }},
        scenario.commands[i].from);
    if (auto* error = std::get_if<std::string>(&inlet)) return std::move(*error);
    auto& own = std::get<std::unique_ptr<Inlet>>(inlet);
    inlet_of.push_back(own == nullptr ? dds_commands.get() : own.get());
    if (own != nullptr) inlets.push_back(std::move(own));
  }
  for (auto& inlet : serial->OtherInlets()) inlets.push_back(std::move(inlet));
  aliases = serial->Aliases();
  transports.push_back(std::move(serial));
  if (dds == nullptr) return {};
  clock = dds->Clock();
  inlets.push_back(std::move(dds_commands));
  transports.push_back(std::move(dds));
  return {};
}

void Channels::TellOf(DatagramWatch& watch, const Scenario& scenario) {
  for (std::size_t i = 0; i < outlets.size(); ++i) {
    outlets[i]->TellOf(watch, scenario.sensors[i].name);
  }
  for (const auto& inlet : inlets) inlet->TellOf(watch);
}

void Channels::Record(const Scenario& scenario, ChannelRecords& records) {
  for (std::size_t i = 0; i < outlets.size(); ++i) {
    if (std::holds_alternative<DdsSensorEnd>(scenario.sensors[i].to)) continue;
    outlets[i] = records.Wrap(i, std::move(outlets[i]));
  }
  for (auto& inlet : inlets) inlet = records.Wrap(std::move(inlet));
}

void Channels::Begin(VirtualDuration realtime_offset) {
  for (const auto& transport : transports) transport->Begin(realtime_offset);
}

}  // namespace tcs
