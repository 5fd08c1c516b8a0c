#include "coordinator/channel/pty/pty_channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "coordinator/channel/json/json_codec.h"
#include "coordinator/channel/on_the_way.h"
#include "coordinator/channel/pty/serial_line.h"
#include "coordinator/channel/pty/terminal.h"

namespace tcs {
namespace {

constexpr std::size_t kLongestLine = 1 << 16;

double Milliseconds(VirtualDuration time) { return static_cast<double>(time.ns()) * 1e-6; }

}  // namespace

// A device on its line.
class PtyChannels::Device {
 public:
  Device(Terminal terminal, SerialPort port)
      : terminal_(std::move(terminal)),
        port_(std::move(port)),
        to_program_(port_.frame_bits, port_.baud),
        from_program_(port_.frame_bits, port_.baud) {}

  const Terminal& terminal() const { return terminal_; }
  const SerialPort& port() const { return port_; }
  VirtualDuration TimeOf(std::size_t bytes) const {
    return to_program_.TimeOf(static_cast<std::int64_t>(bytes));
  }

  // Sends the text `line` from `now` on, or when the serial line is free. Returns the time at which
  // the text's last bit has come.
  VirtualTime Send(const std::string& line, VirtualTime now) {
    const auto fifo = static_cast<std::size_t>(port_.fifo);
    for (std::size_t i = 0; i < line.size(); i += fifo) {
      const std::string bytes = line.substr(i, fifo);
      for (std::size_t k = 0; k < bytes.size(); ++k) to_program_.Send(now);
      on_the_way_.Add(bytes, to_program_.free_at());
    }
    return to_program_.free_at();
  }
  VirtualTime NextDue() const { return on_the_way_.NextDue(); }
  bool HandOver(VirtualTime now) {
    return on_the_way_.Arrive(now, [this](const std::string& bytes) { terminal_.Write(bytes); });
  }

  // The time at which a byte that a program writes at `now` has gone.
  VirtualTime Gone(VirtualTime now) { return from_program_.Send(now); }

  bool takes_commands = false;

 private:
  Terminal terminal_;
  const SerialPort port_;
  SerialLine to_program_, from_program_;
  OnTheWay on_the_way_;
};

// A sensor that the device has.
class PtyChannels::DeviceOutlet final : public Outlet {
 public:
  DeviceOutlet(Device& device, const SensorChannelSpec& spec)
      : device_(device), period_(spec.period), fields_(spec.fields) {}

  bool Send(const Reading& reading, VirtualTime arrives) override {
    waiting_.Add(EncodeReading(reading, fields_) + "\n", arrives);
    return false;
  }
  VirtualTime NextDue() const override { return std::min(waiting_.NextDue(), device_.NextDue()); }
  std::size_t Kept() const override {
    return waiting_.size() + (device_.NextDue().IsNever() ? 0 : 1);
  }
  bool HandOver(VirtualTime now) override {
    waiting_.Arrive(now, [&](const std::string& line) { Begin(line, now); });
    return device_.HandOver(now);
  }

  std::string WhatWasLost() const override {
    if (lost_ == 0) return {};
    return fmt::format(
        "{} of its {} readings were left out because the line was busy: a reading of {} bytes "
        "takes {:.1f} ms at {} baud, and readings are {:.1f} ms apart; lower the rate, or raise "
        "the baud rate",
        lost_, count_, longest_, Milliseconds(device_.TimeOf(longest_)), device_.port().baud,
        Milliseconds(period_));
  }
  std::string WhyUnheard() const override {
    if (device_.terminal().IsOpen()) return {};
    return fmt::format(
        "no program of {} has opened {}, so the samples for it are lost; let a client open it",
        device_.port().robot, device_.port().path);
  }

 private:
  // A device does not say later what it could not say in time.
  void Begin(const std::string& line, VirtualTime now) {
    ++count_;
    longest_ = std::max(longest_, line.size());
    if (busy_until_ > now) {
      ++lost_;
    } else {
      busy_until_ = device_.Send(line, now);
    }
  }

  Device& device_;
  const VirtualDuration period_;
  const std::vector<SensorField> fields_;
  OnTheWay waiting_;  // until the device begins to send it
  VirtualTime busy_until_;
  std::int64_t count_ = 0, lost_ = 0;
  std::size_t longest_ = 0;
};

class PtyChannels::DeviceInlet final : public Inlet {
 public:
  DeviceInlet(Device& device, std::optional<std::size_t> channel)
      : device_(device), channel_(channel) {}

  int fd() const override { return device_.terminal().fd(); }
  bool IsTerminal() const override { return true; }

  void Receive(const CommandSent& now, CommandSink& sink) override {
    const std::string bytes = device_.terminal().Read();
    CheckBaud(sink);
    for (const char byte : bytes) {
      const VirtualTime gone = device_.Gone(now.at);
      if (byte == '\n') {
        TakeLine({gone, now.by}, sink);
        line_.clear();
      } else if (line_.size() <= kLongestLine) {
        line_ += byte;
      }
    }
  }

  Place PlaceOf(std::size_t) const override {
    return {fmt::format("at {} of {}", device_.port().path, device_.port().robot),
            "write its commands there, a line each"};
  }

 private:
  void TakeLine(const CommandSent& sent, CommandSink& sink) {
    if (!channel_.has_value()) return;
    if (line_.find_first_not_of(" \t\r") == std::string::npos) return;
    TakeCommand("the command line", line_, *channel_, sent, sink);
  }

  void CheckBaud(CommandSink& sink) {
    const int baud = device_.terminal().Baud();
    if (has_warned_ || baud == device_.port().baud) return;
    has_warned_ = true;
    sink.Note(fmt::format(
        "a program of {} has set {} to {} baud, but the line has {} in the scenario and keeps it; "
        "on a real line the two ends would not understand each other: use one rate in both",
        device_.port().robot, device_.port().path, baud, device_.port().baud));
  }

  Device& device_;
  const std::optional<std::size_t> channel_;
  std::string line_;  // the part that has come
  bool has_warned_ = false;
};

PtyChannels::PtyChannels() = default;
PtyChannels::~PtyChannels() = default;

std::variant<PtyChannels::Device*, std::string> PtyChannels::Find(const SerialPort& port) {
  std::unique_ptr<Device>& device = devices_[{port.robot, port.path}];
  if (device != nullptr) return device.get();
  auto terminal = Terminal::Open(port.baud);
  if (const auto* why = std::get_if<std::string>(&terminal)) {
    return fmt::format("no terminal can be made for {} of {}: {}", port.path, port.robot, *why);
  }
  device = std::make_unique<Device>(std::move(std::get<Terminal>(terminal)), port);
  return device.get();
}

Opened<Outlet> PtyChannels::OutletOn(const SerialPort& port, const SensorChannelSpec& spec) {
  const auto found = Find(port);
  if (const auto* why = std::get_if<std::string>(&found)) return *why;
  return std::make_unique<DeviceOutlet>(*std::get<Device*>(found), spec);
}

Opened<Inlet> PtyChannels::InletOn(const SerialPort& port, std::size_t channel) {
  const auto found = Find(port);
  if (const auto* why = std::get_if<std::string>(&found)) return *why;
  Device& device = *std::get<Device*>(found);
  device.takes_commands = true;
  return std::make_unique<DeviceInlet>(device, channel);
}

std::vector<std::unique_ptr<Inlet>> PtyChannels::OtherInlets() const {
  std::vector<std::unique_ptr<Inlet>> inlets;
  for (const auto& [name, device] : devices_) {
    if (device->takes_commands) continue;
    inlets.push_back(std::make_unique<DeviceInlet>(*device, std::nullopt));
  }
  return inlets;
}

std::vector<FileAlias> PtyChannels::Aliases() const {
  std::vector<FileAlias> aliases;
  for (const auto& [name, device] : devices_) {
    aliases.push_back({name.first, name.second, device->terminal().path()});
  }
  return aliases;
}

}  // namespace tcs
