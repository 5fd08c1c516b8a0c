// `channels` of a scenario file: how clients meet their robots.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/load_dds.h"
#include "coordinator/scenario/load_instruments.h"
#include "coordinator/scenario/load_joints.h"
#include "coordinator/scenario/load_rotors.h"
#include "coordinator/scenario/load_sensing.h"
#include "coordinator/scenario/load_serial.h"
#include "coordinator/scenario/load_sockets.h"
#include "coordinator/scenario/sections.h"

namespace tcs {
namespace {

constexpr double kLowestRate = 1e-3;
constexpr double kHighestRate = 1e6;

enum class ChannelType { kUdpJson, kUnixJson, kPty, kDds };

ChannelType LoadType(const YamlValue& value) {
  const std::string text = value.AsText();
  if (text == "udp_json") return ChannelType::kUdpJson;
  if (text == "unix_json") return ChannelType::kUnixJson;
  if (text == "pty") return ChannelType::kPty;
  if (text == "dds") return ChannelType::kDds;
  value.Fail("is the unknown '" + text + "'; " +
             Suggest(text, {"udp_json", "unix_json", "pty", "dds"}, "types"));
}

// The ends that the channels take so far.
struct Ends {
  UdpEndpoints udp;
  UnixNames unix_names;
  SerialPorts serial;
  DdsTopics topics;
};

// Adds the keys that the type brings along; `socket` is the key that says where a socket is.
void AddKeys(ChannelType type, const char* socket, std::vector<std::string>* keys) {
  switch (type) {
    case ChannelType::kUdpJson:
    case ChannelType::kUnixJson:
      keys->push_back(socket);
      break;
    case ChannelType::kPty:
      keys->insert(keys->end(), SerialPorts::Keys().begin(), SerialPorts::Keys().end());
      break;
    case ChannelType::kDds:
      keys->insert(keys->end(), {"message", "topic", "domain", "qos"});
      break;
  }
}

SensorChannelSpec LoadSensors(const YamlMap::Entry& entry, const YamlValue& value, ChannelType type,
                              const Scenario& scenario, Ends* ends) {
  const YamlMap map = value.AsMap();
  const bool of_instrument = IsAboutInstrument(map);
  const bool of_joints = !of_instrument && IsOfModel(map, "bodies");
  std::vector<std::string> keys = {"rate", "latency", "dropout", "jitter"};
  if (of_instrument) {
    keys = InstrumentKeys(map);
  } else if (of_joints) {
    keys.insert(keys.begin(), {"model", "joints", "noise", "bias"});
  } else {
    keys.insert(keys.begin(), {"bodies", "noise", "bias"});
    if (type != ChannelType::kDds) keys.push_back("fields");
  }
  AddKeys(type, "to", &keys);
  map.AllowOnly(keys);
  SensorChannelSpec channel;
  channel.name = entry.key;
  if (const YamlValue* rate = map.Find("rate")) channel.period = LoadPeriod(*rate);
  if (const YamlValue* latency = map.Find("latency")) channel.latency = latency->AsDuration();
  channel.errors = LoadSensorErrors(map, entry.key, scenario.seed);
  if (of_instrument) {
    LoadInstrument(map, scenario, &channel);
    if (type != ChannelType::kDds) CheckFitsDatagram(map, *channel.instrument);
  } else if (of_joints) {
    channel.joints = LoadJointGroup(map, scenario);
    LoadJointErrors(map, &channel.errors);
  } else {
    channel.bodies = FindBodies(map.Require("bodies", "bodies: [predator]"), scenario);
    LoadBodyErrors(map, &channel.errors);
  }
  if (const YamlValue* fields = map.Find("fields")) channel.fields = LoadSensorFields(*fields);
  switch (type) {
    case ChannelType::kUdpJson:
      channel.to = ends->udp.LoadReceiver(map.Require("to", "to: \"127.0.0.1:47010\""));
      break;
    case ChannelType::kUnixJson:
      channel.to = ends->unix_names.Load(map.Require("to", "to: eyes.sock"));
      break;
    case ChannelType::kPty:
      channel.to = ends->serial.Load(map, false, scenario);
      break;
    case ChannelType::kDds:
      channel.to = LoadDdsSensorEnd(map, channel, &ends->topics);
      break;
  }
  return channel;
}

// The thing that a channel of commands is about.
enum class Commanded { kBody, kLink, kJoints, kRotors };

Commanded CommandedBy(const YamlMap& map) {
  const YamlValue* on = map.Find("on");
  const YamlValue* model = map.Find("model");
  const YamlValue* rotors = map.Find("rotors");
  if (on != nullptr) {
    if (model != nullptr) model->Fail("cannot be given beside on; make two channels of it");
    return Commanded::kLink;
  }
  if (!IsOfModel(map, "body")) return Commanded::kBody;
  const YamlValue* joints = map.Find("joints");
  if (rotors != nullptr && joints != nullptr) {
    joints->Fail("cannot be given beside rotors; make two channels of it");
  }
  return rotors != nullptr ? Commanded::kRotors : Commanded::kJoints;
}

std::vector<std::string> KeysOf(Commanded commanded, const YamlMap& map) {
  switch (commanded) {
    case Commanded::kBody:
      return {"body", "latency", "limits", "axes", "lag"};
    case Commanded::kLink:
      return {"on", "latency", "limits", "axes"};
    case Commanded::kJoints:
      return JointDriveKeys(map);
    case Commanded::kRotors:
      break;
  }
  return {"model", "rotors", "drive", "latency"};
}

LinkTarget LoadPushedLink(const YamlValue& value, const Scenario& scenario) {
  std::string name;
  const int link = LoadLink(value, scenario, &name);
  return {value.AsText(), link};
}

void LoadTarget(const YamlMap& map, Commanded commanded, Scenario* scenario,
                CommandChannelSpec* channel) {
  switch (commanded) {
    case Commanded::kBody:
      channel->body = FindBody(map.Require("body", "body: predator"), *scenario);
      return LoadCommandEffect(map, "body", channel);
    case Commanded::kLink:
      channel->link = LoadPushedLink(*map.Find("on"), *scenario);
      return LoadCommandEffect(map, "link", channel);
    case Commanded::kJoints:
      channel->joints = LoadJointDrive(map, *scenario);
      SetDriveLag(map, *channel->joints, scenario);
      break;
    case Commanded::kRotors:
      channel->rotors = LoadRotorDrive(map, *scenario);
      break;
  }
  if (const YamlValue* latency = map.Find("latency")) channel->latency = latency->AsDuration();
}

CommandChannelSpec LoadCommands(const YamlMap::Entry& entry, const YamlValue& value,
                                ChannelType type, Scenario* scenario, Ends* ends) {
  const YamlMap map = value.AsMap();
  const Commanded commanded = CommandedBy(map);
  std::vector<std::string> keys = KeysOf(commanded, map);
  AddKeys(type, "listen", &keys);
  map.AllowOnly(keys);
  CommandChannelSpec channel;
  channel.name = entry.key;
  LoadTarget(map, commanded, scenario, &channel);
  switch (type) {
    case ChannelType::kUdpJson:
      channel.from = ends->udp.Load(map.Require("listen", "listen: \"127.0.0.1:47011\""));
      break;
    case ChannelType::kUnixJson:
      channel.from = ends->unix_names.Load(map.Require("listen", "listen: hands.sock"));
      break;
    case ChannelType::kPty:
      channel.from = ends->serial.Load(map, true, *scenario);
      break;
    case ChannelType::kDds:
      channel.from = LoadDdsCommandEnd(map, channel, &ends->topics);
      break;
  }
  return channel;
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

void LoadChannels(const YamlMap& top, const Variables& variables, Scenario* scenario) {
  const std::optional<NetworkSpec>& network = scenario->network;
  Ends ends{UdpEndpoints(variables, network), UnixNames(variables, network.has_value()), {}, {}};
  if (const YamlValue* clock = top.Find("clock")) scenario->clock = LoadClock(*clock, &ends.topics);
  if (const YamlValue* ros = top.Find("ros")) scenario->ros = LoadRosRelease(*ros);
  const YamlValue* channels = top.Find("channels");
  if (channels == nullptr) return;
  const YamlMap channel_map = channels->AsMap();
  channel_map.ForEach([&](const YamlMap::Entry& entry) {
    CheckName(entry);
    if (!scenario->world) {
      entry.value.Fail("needs bodies, but the scenario has none; add dynamics and bodies");
    }
    const YamlMap map = entry.value.AsMap();
    map.AllowOnly({"type", "sensors", "commands"});
    const ChannelType type = LoadType(map.Require("type", "type: udp_json"));
    const YamlValue* sensors = map.Find("sensors");
    const YamlValue* commands = map.Find("commands");
    if ((sensors == nullptr) == (commands == nullptr)) {
      entry.value.Fail(sensors == nullptr
                           ? "carries nothing; add the key sensors or commands"
                           : "has both sensors and commands; make two channels of it");
    }
    if (sensors != nullptr) {
      scenario->sensors.push_back(LoadSensors(entry, *sensors, type, *scenario, &ends));
    } else {
      scenario->commands.push_back(LoadCommands(entry, *commands, type, scenario, &ends));
    }
  });
}

}  // namespace tcs
