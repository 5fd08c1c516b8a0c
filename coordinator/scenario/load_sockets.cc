#include "coordinator/scenario/load_sockets.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace tcs {
namespace {

constexpr std::string_view kAnyAddress = "0.0.0.0";

}  // namespace

UdpEndpoint UdpEndpoints::LoadEndpoint(const YamlValue& value) const {
  constexpr std::string_view kExample = "write ADDRESS:PORT, like \"127.0.0.1:47010\"";
  const std::string text = Substitute(value, variables_);
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) {
    value.Fail("is '" + text + "', which has no port; " + std::string(kExample));
  }
  UdpEndpoint endpoint;
  endpoint.host = text.substr(0, colon);
  in_addr address;
  if (inet_pton(AF_INET, endpoint.host.c_str(), &address) != 1) {
    value.Fail("has the address '" + endpoint.host + "', which is not IPv4 in numbers; " +
               std::string(kExample));
  }
  const std::string port = text.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (error != std::errc() || end != port.data() + port.size() || endpoint.port == 0) {
    value.Fail("has the port '" + port + "', which is not a number from 1 to 65535; " +
               std::string(kExample));
  }
  return endpoint;
}

UdpEndpoint UdpEndpoints::Load(const YamlValue& value) {
  const UdpEndpoint endpoint = LoadEndpoint(value);
  if (network_ &&
      std::ranges::find(network_->addresses, endpoint.host) == network_->addresses.end()) {
    value.Fail(
        "has the address " + endpoint.host + ", which is no robot's: with `network` each " +
        "robot has its own 127.0.0.1; write the address of the robot whose body it is, like " +
        network_->addresses.front());
  }
  for (const Use& use : uses_) {
    const bool same_host = use.endpoint.host == endpoint.host || use.endpoint.host == kAnyAddress ||
                           endpoint.host == kAnyAddress;
    if (use.endpoint.port == endpoint.port && same_host) {
      value.Fail("uses port " + std::to_string(endpoint.port) + " again, which is that of " +
                 use.name + " " + use.place.Reference() + "; give each channel a port of its own");
    }
  }
  uses_.push_back({endpoint, value.name(), value.place()});
  return endpoint;
}

UdpEndpoint UdpEndpoints::LoadReceiver(const YamlValue& value) {
  const UdpEndpoint endpoint = Load(value);
  if (endpoint.host == kAnyAddress) {
    value.Fail("has the address 0.0.0.0, to which nothing can be sent; name one, like 127.0.0.1");
  }
  return endpoint;
}

UnixName UnixNames::Load(const YamlValue& value) {
  const std::string written = Substitute(value, variables_);
  UnixName name{.name = written, .is_abstract = written.starts_with("@")};
  if (name.is_abstract) {
    name.name.erase(0, 1);
  } else if (!written.empty()) {
    name.name = (std::filesystem::path(variables_.scenario_directory) / written)
                    .lexically_normal()
                    .string();
  }
  if (name.name.empty()) {
    value.Fail("is '" + written + "'; write the path of a UNIX socket, like eyes.sock, or a name " +
               "without a file, like \"@eyes\"");
  }
  if (name.name.size() > UnixName::kLongest) {
    value.Fail("is '" + name.Text() + "', which is longer than a UNIX socket's name may be (" +
               std::to_string(UnixName::kLongest) + " bytes); choose a shorter path, or a name " +
               "without a file, like \"@eyes\"");
  }
  if (name.is_abstract && has_network_) {
    value.Fail("is '" + written + "', a name without a file, which with `network` each robot has " +
               "for itself; write the path of a UNIX socket, like eyes.sock");
  }
  for (const Use& use : uses_) {
    if (use.text != name.Text()) continue;
    value.Fail("uses the UNIX socket '" + name.Text() + "' again, which is that of " + use.name +
               " " + use.place.Reference() + "; give each channel one of its own");
  }
  uses_.push_back({name.Text(), value.name(), value.place()});
  return name;
}

}  // namespace tcs
