// `channels` of a scenario file: how clients meet their robots.
#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "coordinator/scenario/load_dds.h"
#include "coordinator/scenario/nearest.h"
#include "coordinator/scenario/sections.h"

namespace tcs {
namespace {

constexpr double kLowestRate = 1e-3;
constexpr double kHighestRate = 1e6;
constexpr std::string_view kAnyAddress = "0.0.0.0";

UdpEndpoint LoadEndpoint(const YamlValue& value) {
  constexpr std::string_view kExample = "write ADDRESS:PORT, like \"127.0.0.1:47010\"";
  const std::string text = value.AsText();
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

// The endpoints given so far: each belongs to one channel.
class Endpoints {
 public:
  UdpEndpoint Load(const YamlValue& value) {
    const UdpEndpoint endpoint = LoadEndpoint(value);
    for (const Use& use : uses_) {
      const bool same_host = use.endpoint.host == endpoint.host ||
                             use.endpoint.host == kAnyAddress || endpoint.host == kAnyAddress;
      if (use.endpoint.port == endpoint.port && same_host) {
        value.Fail("uses port " + std::to_string(endpoint.port) + " again, which is that of " +
                   use.name + " " + use.place.Reference() +
                   "; give each channel a port of its own");
      }
    }
    uses_.push_back({endpoint, value.name(), value.place()});
    return endpoint;
  }

 private:
  struct Use {
    UdpEndpoint endpoint;
    std::string name;
    Place place;
  };
  std::vector<Use> uses_;
};

SensorChannelSpec LoadSensors(const YamlMap::Entry& entry, const YamlValue& value,
                              const Scenario& scenario, Endpoints* endpoints) {
  const YamlMap map = value.AsMap();
  map.AllowOnly({"bodies", "rate", "to", "latency"});
  SensorChannelSpec channel;
  channel.name = entry.key;
  channel.bodies = FindBodies(map.Require("bodies", "bodies: [predator]"), scenario);
  if (const YamlValue* rate = map.Find("rate")) channel.period = LoadPeriod(*rate);
  if (const YamlValue* latency = map.Find("latency")) channel.latency = latency->AsDuration();
  const YamlValue& to = map.Require("to", "to: \"127.0.0.1:47010\"");
  const UdpEndpoint endpoint = endpoints->Load(to);
  if (endpoint.host == kAnyAddress) {
    to.Fail("has the address 0.0.0.0, to which nothing can be sent; name one, like 127.0.0.1");
  }
  channel.to = endpoint;
  return channel;
}

CommandChannelSpec LoadCommands(const YamlMap::Entry& entry, const YamlValue& value,
                                const Scenario& scenario, Endpoints* endpoints) {
  const YamlMap map = value.AsMap();
  map.AllowOnly({"body", "listen", "latency"});
  CommandChannelSpec channel;
  channel.name = entry.key;
  channel.body = FindBody(map.Require("body", "body: predator"), scenario);
  if (const YamlValue* latency = map.Find("latency")) channel.latency = latency->AsDuration();
  channel.from = endpoints->Load(map.Require("listen", "listen: \"127.0.0.1:47011\""));
  return channel;
}

bool IsDds(const YamlValue& type) {
  const std::string text = type.AsText();
  if (text != "dds" && text != "udp_json") {
    type.Fail("is the unknown '" + text + "'; " + Suggest(text, {"udp_json", "dds"}, "types"));
  }
  return text == "dds";
}

}  // namespace

VirtualDuration LoadPeriod(const YamlValue& value) {
  const double rate = value.AsPositiveNumber(" (Hz)");
  if (rate < kLowestRate || rate > kHighestRate) {
    value.Fail("is " + value.AsText() + "; it must be between 0.001 and 1000000 Hz");
  }
  return VirtualDuration::Nanoseconds(std::llround(1e9 / rate));
}

std::vector<int> FindBodies(const YamlValue& value, const Scenario& scenario) {
  std::vector<int> bodies;
  for (const YamlValue& name : value.AsList("[predator]")) {
    const int body = FindBody(name, scenario);
    if (std::find(bodies.begin(), bodies.end(), body) != bodies.end()) {
      name.Fail("names the body '" + name.AsText() + "' a second time; remove it");
    }
    bodies.push_back(body);
  }
  return bodies;
}

void LoadChannels(const YamlMap& top, Scenario* scenario) {
  Endpoints endpoints;
  DdsTopics topics;
  if (const YamlValue* clock = top.Find("clock")) scenario->clock = LoadClock(*clock, &topics);
  if (const YamlValue* ros = top.Find("ros")) scenario->ros = LoadRosRelease(*ros);
  const YamlValue* channels = top.Find("channels");
  if (channels == nullptr) return;
  const YamlMap channel_map = channels->AsMap();
  for (const YamlMap::Entry& entry : channel_map.entries()) {
    CheckName(entry);
    if (!scenario->world) {
      entry.value.Fail("needs bodies, but the scenario has none; add dynamics and bodies");
    }
    const YamlMap map = entry.value.AsMap();
    map.AllowOnly({"type", "sensors", "commands"});
    const bool is_dds = IsDds(map.Require("type", "type: udp_json"));
    const YamlValue* sensors = map.Find("sensors");
    const YamlValue* commands = map.Find("commands");
    if ((sensors == nullptr) == (commands == nullptr)) {
      entry.value.Fail(sensors == nullptr
                           ? "carries nothing; add the key sensors or commands"
                           : "has both sensors and commands; make two channels of it");
    }
    if (sensors != nullptr) {
      scenario->sensors.push_back(is_dds ? LoadDdsSensors(entry, *sensors, *scenario, &topics)
                                         : LoadSensors(entry, *sensors, *scenario, &endpoints));
    } else {
      scenario->commands.push_back(is_dds ? LoadDdsCommands(entry, *commands, *scenario, &topics)
                                          : LoadCommands(entry, *commands, *scenario, &endpoints));
    }
  }
}

}  // namespace tcs
