#include "coordinator/scenario/load_dds.h"

#include <algorithm>
#include <optional>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/load_instruments.h"
#include "coordinator/scenario/own_topics.h"
#include "coordinator/scenario/sections.h"

namespace tcs {
namespace {

// The ports of higher domains would lie beyond 65535.
constexpr std::int64_t kHighestDomain = 232;
constexpr std::int64_t kGreatestDepth = 1'000'000;

// The enumerator of the kind that is written as the text `value`.
template <class Kind>
Kind LoadPolicy(const YamlValue& value, std::initializer_list<Kind> kinds,
                std::string_view plural) {
  const std::string text = value.AsText();
  std::vector<std::string> known;
  for (const Kind kind : kinds) {
    known.push_back(NameOf(kind));
    if (text == known.back()) return kind;
  }
  value.Fail("is the unknown '" + text + "'; " + Suggest(text, known, plural));
}

enum class Side { kWriter, kReader };

void LoadHistory(const YamlMap& map, dds::Qos* qos) {
  const YamlValue* depth = map.Find("depth");
  if (const YamlValue* v = map.Find("history")) {
    qos->history =
        LoadPolicy(*v, {dds::History::kKeepLast, dds::History::kKeepAll}, "kinds of history");
  }
  if (depth == nullptr) return;
  if (qos->history == dds::History::kKeepAll) {
    depth->Fail("is for the history keep_last, but here it is keep_all; remove one of them");
  }
  qos->depth = static_cast<int>(depth->AsInteger(1, kGreatestDepth));
}

// ROS 2's profiles, by their names.
dds::Qos LoadProfile(const YamlValue& value) {
  const std::string name = value.AsText();
  if (name == "default") return {};
  if (name == "sensor_data") return {.reliability = dds::Reliability::kBestEffort, .depth = 5};
  value.Fail("is the unknown '" + name + "'; " +
             Suggest(name, {"default", "sensor_data"}, "profiles"));
}

// Loads the policies over those that `qos` has already.
void LoadQos(const YamlValue& value, Side side, dds::Qos* qos) {
  if (!value.IsMap()) {
    *qos = LoadProfile(value);
    return;
  }
  const YamlMap map = value.AsMap();
  map.AllowOnly({"reliability", "history", "depth", "durability", "deadline", "lifespan", "lease"});
  if (const YamlValue* v = map.Find("reliability")) {
    qos->reliability = LoadPolicy(*v, {dds::Reliability::kReliable, dds::Reliability::kBestEffort},
                                  "kinds of reliability");
  }
  LoadHistory(map, qos);
  if (const YamlValue* v = map.Find("durability")) {
    qos->durability = LoadPolicy(*v, {dds::Durability::kVolatile, dds::Durability::kTransientLocal},
                                 "kinds of durability");
  }
  if (const YamlValue* v = map.Find("deadline")) qos->deadline = v->AsPositiveDuration();
  if (const YamlValue* v = map.Find("lease")) qos->lease = v->AsPositiveDuration();
  if (const YamlValue* v = map.Find("lifespan")) {
    if (side == Side::kReader) {
      v->Fail("is for writers, and commands are read; remove it, or set it in the client");
    }
    qos->lifespan = v->AsPositiveDuration();
  }
}

// Loads the values over those that `end` has already; a topic is required if `end` has none.
DdsTopicSpec LoadEnd(const YamlMap& map, std::string_view message, Side side, DdsTopicSpec end,
                     DdsTopics* topics) {
  if (const YamlValue* domain = map.Find("domain")) {
    end.domain = static_cast<int>(domain->AsInteger(0, kHighestDomain));
  }
  if (const YamlValue* v = map.Find("qos")) LoadQos(*v, side, &end.qos);
  if (!end.topic.empty() && map.Find("topic") == nullptr) {
    topics->Add(map.place(), end.topic, end.domain, message);
  } else {
    end.topic = topics->Load(map.Require("topic", "topic: /odom"), end.domain, message);
  }
  return end;
}

// A writer that offers a deadline writes at least as often.
void CheckDeadline(const YamlMap& map, const DdsTopicSpec& end, VirtualDuration period) {
  if (!end.qos.deadline || *end.qos.deadline >= period) return;
  map.Find("qos")
      ->AsMap()
      .Find("deadline")
      ->Fail(
          "is shorter than the time between two samples, so that it would always be missed; make "
          "it "
          "longer, or the rate higher");
}

// The place of `value` in `names`.
std::size_t LoadMessage(const YamlValue& value, const std::vector<std::string>& names) {
  const std::string name = dds::FullMessageName(value.AsText());
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    value.Fail("is the unknown '" + value.AsText() + "'; " + Suggest(name, names, "messages"));
  }
  return static_cast<std::size_t>(found - names.begin());
}

// The message for a sensor of bodies or of joints.
dds::SensorMessage LoadSensorMessage(const YamlValue& value) {
  const std::vector<std::string>& all = dds::SensorMessageNames();
  const std::string name = dds::FullMessageName(value.AsText());
  if (std::find(all.begin() + dds::kBodyMessages, all.end(), name) != all.end()) {
    value.Fail("is " + name +
               ", which only sensors on a robot's links write; name the sensor, like kind: lidar");
  }
  return static_cast<dds::SensorMessage>(
      LoadMessage(value, {all.begin(), all.begin() + dds::kBodyMessages}));
}

// The message need not be given: the kind of sensor says which one it writes.
DdsSensorEnd LoadInstrumentEnd(const YamlMap& map, const SensorChannelSpec& sensor,
                               DdsTopics* topics) {
  DdsSensorEnd to;
  to.message = MessageOf(map);
  const std::string& name = dds::NameOf(to.message);
  if (const YamlValue* v = map.Find("message")) {
    if (dds::FullMessageName(v->AsText()) != name) {
      v->Fail("is " + v->AsText() + ", but this kind of sensor writes " + name + "; remove it");
    }
  }
  to.end = LoadEnd(map, name, Side::kWriter, DefaultEndOf(map), topics);
  CheckDeadline(map, to.end, sensor.period);
  return to;
}

// The message that nearly everybody reads.
dds::CommandMessage MessageFor(const CommandChannelSpec& command) {
  if (command.rotors) return dds::CommandMessage::kFloat64MultiArray;
  if (!command.joints) return dds::CommandMessage::kWrench;
  if (command.joints->wheels) return dds::CommandMessage::kTwist;
  if (command.joints->setpoint_period) return dds::CommandMessage::kJointTrajectory;
  return dds::CommandMessage::kFloat64MultiArray;
}

dds::CommandMessage LoadCommandMessage(const YamlValue& value, const CommandChannelSpec& command) {
  const std::string name = dds::FullMessageName(value.AsText());
  const std::string& twist = dds::NameOf(dds::CommandMessage::kTwist);
  if (!command.joints && name == twist) {
    value.Fail(
        "is a velocity, but bodies are moved by forces; read geometry_msgs/msg/Wrench here, and "
        "let a client turn velocities into forces");
  }
  const auto message =
      static_cast<dds::CommandMessage>(LoadMessage(value, dds::CommandMessageNames()));
  if (!command.joints) return message;
  const auto is_for = [&](bool wants, dds::CommandMessage wanted, const char* who,
                          const char* drive) {
    const std::string& only = dds::NameOf(wanted);
    if (wants && name != only) {
      value.Fail("is " + name + ", but " + who + " told by " + only + "; read that");
    }
    if (!wants && name == only) value.Fail(std::string("wants drive: ") + drive + "; add that");
  };
  is_for(command.joints->wheels.has_value(), dds::CommandMessage::kTwist,
         "how fast a robot on wheels is to go is", "differential");
  is_for(command.joints->setpoint_period.has_value(), dds::CommandMessage::kJointTrajectory,
         "trajectories are", "trajectory");
  return message;
}

}  // namespace

std::string DdsTopics::Load(const YamlValue& value, int domain, std::string_view message) {
  const std::string topic = value.AsText();
  if (const auto wrong = dds::WhatIsWrongWithTopic(topic)) {
    value.Fail("is '" + topic + "', which " + *wrong + "; write a topic in full, like /odom");
  }
  Add(value, topic, domain, message);
  return topic;
}

void DdsTopics::Add(const YamlValue& value, const std::string& topic, int domain,
                    std::string_view message) {
  for (const Use& use : uses_) {
    if (use.topic != topic || use.domain != domain || use.message == message) continue;
    value.Fail("uses the topic " + topic + " for " + std::string(message) + ", but " + use.name +
               " " + use.place.Reference() + " uses it for " + use.message +
               "; give each a topic of its own");
  }
  uses_.push_back({topic, domain, std::string(message), value.name(), value.place()});
}

DdsSensorEnd LoadDdsSensorEnd(const YamlMap& map, const SensorChannelSpec& sensor,
                              DdsTopics* topics) {
  DdsSensorEnd to;
  if (sensor.instrument) return LoadInstrumentEnd(map, sensor, topics);
  const YamlValue& message = map.Require("message", "message: nav_msgs/msg/Odometry");
  to.message = LoadSensorMessage(message);
  const std::string& name = dds::NameOf(to.message);
  if (sensor.joints && to.message != dds::SensorMessage::kJointState) {
    map.Find("message")->Fail("is " + name +
                              ", but joints are told of by sensor_msgs/msg/JointState; write that");
  }
  if (sensor.bodies.size() > 1 && to.message != dds::SensorMessage::kJointState) {
    map.Find("bodies")->Fail("names " + std::to_string(sensor.bodies.size()) + " bodies, but " +
                             name + " tells of one; make a channel for each");
  }
  to.end = LoadEnd(map, name, Side::kWriter, {}, topics);
  CheckDeadline(map, to.end, sensor.period);
  return to;
}

DdsCommandEnd LoadDdsCommandEnd(const YamlMap& map, const CommandChannelSpec& command,
                                DdsTopics* topics) {
  DdsCommandEnd from;
  from.message = LoadCommandMessage(
      map.Require("message", "message: " + dds::NameOf(MessageFor(command))), command);
  const bool has_goals = command.joints || command.rotors;
  if (has_goals == (from.message == dds::CommandMessage::kWrench)) {
    const std::string what = command.joints ? "joints" : "rotors";
    map.Find("message")->Fail(
        "is " + dds::NameOf(from.message) +
        (has_goals ? ", but " + what +
                         " are driven by std_msgs/msg/Float64MultiArray or "
                         "sensor_msgs/msg/JointState; read one of these"
                   : ", but a body is moved by geometry_msgs/msg/Wrench; read that"));
  }
  // Best effort matches what every writer offers; on the way to the coordinator nothing is lost.
  from.end.qos.reliability = dds::Reliability::kBestEffort;
  from.end = LoadEnd(map, dds::NameOf(from.message), Side::kReader, from.end, topics);
  return from;
}

ClockSpec LoadClock(const YamlValue& value, DdsTopics* topics) {
  const YamlMap map = value.AsMap();
  map.AllowOnly({"topic", "rate", "domain", "qos"});
  ClockSpec clock;
  if (const YamlValue* rate = map.Find("rate")) clock.period = LoadPeriod(*rate);
  clock.end.topic = "/clock";
  clock.end.qos.depth = 1;
  clock.end = LoadEnd(map, dds::kClockMessageName, Side::kWriter, clock.end, topics);
  CheckDeadline(map, clock.end, clock.period);
  return clock;
}

dds::RosRelease LoadRosRelease(const YamlValue& value) {
  const std::string text = value.AsText();
  if (text == "humble") return dds::RosRelease::kHumble;
  const std::vector<std::string> later = {"iron", "jazzy", "kilted", "rolling"};
  if (std::find(later.begin(), later.end(), text) != later.end()) return dds::RosRelease::kIron;
  std::vector<std::string> known = later;
  known.insert(known.begin(), "humble");
  value.Fail("is the unknown '" + text + "'; " + Suggest(text, known, "releases"));
}

void CheckDdsTransports(const YamlMap& top, Scenario* scenario) {
  if (!scenario->network) return;
  const std::string topics = NamesOfOwnTopics(*scenario);
  if (topics.empty()) return;
  const YamlMap robots = RobotsOf(top).AsMap();
  for (const YamlMap::Entry& robot : robots.entries()) {
    const YamlMap robot_map = robot.value.AsMap();
    const YamlMap client_map = robot_map.Find("clients")->AsMap();
    for (const YamlMap::Entry& entry : client_map.entries()) {
      const YamlMap client = entry.value.AsMap();
      const YamlValue* dds = client.Find("dds");
      if (dds == nullptr || dds->AsText() != "sockets") continue;
      scenario->warnings.push_back(
          dds->place().Prefix() + dds->name() +
          " is sockets, and with `network` robots have hosts of their own, so nothing of this "
          "client's ever meets the scenario's topics (" +
          topics +
          "); remove `dds` for a Cyclone DDS program, or `network`, or give the client channels of "
          "the type udp_json");
    }
  }
}

}  // namespace tcs
