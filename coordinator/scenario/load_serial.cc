#include "coordinator/scenario/load_serial.h"

#include <algorithm>

#include "coordinator/errors/nearest.h"

namespace tcs {
namespace {

constexpr std::int64_t kSlowestBaud = 50, kFastestBaud = 100'000'000;  // baud
constexpr std::int64_t kLargestFifo = 4096;
constexpr std::size_t kLongestPath = 255;

std::string LoadRobotOf(const YamlMap& map, const Scenario& scenario) {
  const std::vector<RobotSpec>& robots = scenario.robots;
  if (map.Find("robot") == nullptr && robots.size() == 1) return robots.front().name;
  // There is none where all robots have mistakes of their own.
  const std::string example = robots.empty() ? "NAME" : robots.front().name;
  const YamlValue& value = map.Require("robot", "robot: " + example);
  const std::string name = value.AsText();
  std::vector<std::string> known;
  for (const RobotSpec& robot : robots) known.push_back(robot.name);
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    value.FailAbout(name,
                    "names the unknown robot '" + name + "'; " + Suggest(name, known, "robots"));
  }
  return name;
}

std::string LoadDevice(const YamlMap& map) {
  const YamlValue& value = map.Require("device", "device: /dev/ttyUSB0");
  const std::string path = value.AsText();
  if (!path.starts_with('/') || path.size() > kLongestPath ||
      path.find('\n') != std::string::npos) {
    value.Fail("is '" + path + "'; write the whole path that the robot's programs open, like " +
               "/dev/ttyUSB0");
  }
  return path;
}

// With start and stop: 8N1 has 10 bits.
int LoadFrame(const YamlValue& value) {
  const std::string text = value.AsText();
  const bool fits = text.size() == 3 && text[0] >= '5' && text[0] <= '8' &&
                    std::string_view("NEO").find(text[1]) != std::string_view::npos &&
                    (text[2] == '1' || text[2] == '2');
  if (!fits) {
    value.Fail("is '" + text + "'; write data bits (5 to 8), parity (N, E or O) and stop bits " +
               "(1 or 2), like 8N1");
  }
  return 1 + (text[0] - '0') + (text[1] == 'N' ? 0 : 1) + (text[2] - '0');
}

}  // namespace

const std::vector<std::string>& SerialPorts::Keys() {
  static const std::vector<std::string> keys = {"device", "robot", "baud", "frame", "fifo"};
  return keys;
}

SerialPort SerialPorts::Load(const YamlMap& map, bool for_commands, const Scenario& scenario) {
  SerialPort port;
  port.robot = LoadRobotOf(map, scenario);
  port.path = LoadDevice(map);
  const auto same = std::find_if(uses_.begin(), uses_.end(), [&](const Use& use) {
    return use.port.robot == port.robot && use.port.path == port.path;
  });
  if (same != uses_.end()) port = same->port;
  const auto differs = [&](const YamlValue& value) {
    value.Fail("differs from that of " + same->name + " " + same->place.Reference() +
               " for the same device; a line has one");
  };
  const auto take = [&](const char* key, int* of, auto load) {
    const YamlValue* value = map.Find(key);
    if (value == nullptr) return;
    const int written = load(*value);
    if (same != uses_.end() && written != *of) differs(*value);
    *of = written;
  };
  take("baud", &port.baud, [](const YamlValue& value) {
    return static_cast<int>(value.AsInteger(kSlowestBaud, kFastestBaud));
  });
  take("frame", &port.frame_bits, LoadFrame);
  take("fifo", &port.fifo,
       [](const YamlValue& value) { return static_cast<int>(value.AsInteger(1, kLargestFifo)); });
  for (const Use& use : uses_) {
    if (for_commands && use.for_commands && use.port.path == port.path &&
        use.port.robot == port.robot) {
      map.Find("device")->Fail("is " + port.path + " again, which carries the commands of " +
                               use.name + " " + use.place.Reference() +
                               "; give each channel of commands a device of its own");
    }
  }
  uses_.push_back({port, map.place().name(), map.place().place(), for_commands});
  return port;
}

}  // namespace tcs
