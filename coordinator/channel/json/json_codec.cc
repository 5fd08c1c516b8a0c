#include "coordinator/channel/json/json_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "coordinator/channel/json/json_measurement.h"
#include "coordinator/channel/json/json_text.h"
#include "coordinator/channel/json/plain_command.h"

namespace tcs {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kExample = R"({"force": [0, 0, 0], "torque": [0, 0, 0]})";
constexpr std::size_t kLongestQuote = 40;

// A text from a program, quoted: short and printable.
std::string Quote(const std::string& text) {
  const bool cut = text.size() > kLongestQuote;
  return Json(cut ? text.substr(0, kLongestQuote) + "..." : text)
      .dump(-1, ' ', true, Json::error_handler_t::replace);
}

DecodeError Mistake(const std::string& what, std::string_view example = kExample) {
  return DecodeError{what + "; send an object like " + std::string(example)};
}

// The text as a JSON object; else what is wrong with it.
std::variant<Json, DecodeError> ParseObject(std::string_view text, std::string_view example) {
  Json object;
  try {
    object = Json::parse(text);
  } catch (const Json::parse_error& error) {
    return Mistake("is not valid JSON at byte " + std::to_string(error.byte), example);
  } catch (const Json::out_of_range&) {
    return Mistake("holds a number too large for a double", example);
  }
  if (object.is_object()) return object;
  return Mistake(std::string("is of the type ") + object.type_name(), example);
}

std::optional<double> FiniteNumber(const Json& value) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

// Three finite numbers; none if `value` is anything else.
std::optional<std::array<double, 3>> Vector3(const Json& value) {
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  std::array<double, 3> vector{};
  for (std::size_t i = 0; i < vector.size(); ++i) {
    const auto number = FiniteNumber(value[i]);
    if (!number) return std::nullopt;
    vector[i] = *number;
  }
  return vector;
}

void AppendField(const BodyReading& body, SensorField field, std::string& text) {
  switch (field) {
    case SensorField::kPosition:
      return AppendList(body.state.position_m, text);
    case SensorField::kOrientation:
      return AppendList(body.state.orientation_xyzw, text);
    case SensorField::kLinearVelocity:
      return AppendList(body.state.linear_velocity_mps, text);
    case SensorField::kAngularVelocity:
      return AppendList(body.state.angular_velocity_radps, text);
    case SensorField::kAngularRate:
      return AppendList(body.felt.angular_rate_radps, text);
    case SensorField::kProperAcceleration:
      if (!body.felt.proper_acceleration_mps2.has_value()) {
        text += "null";
        return;
      }
      return AppendList(*body.felt.proper_acceleration_mps2, text);
    case SensorField::kCount:
      break;
  }
}

std::string BeginAt(VirtualTime at) {
  std::string text = R"({"time":)";
  // Divided, not multiplied by 1e-9: the double nearest to the decimal fraction.
  AppendNumber(static_cast<double>(at.ns()) / 1e9, text);
  return text;
}

}  // namespace

// Written out rather than built as a tree first: a fleet sends thousands of these a second.
std::string EncodeReading(const Reading& reading, std::span<const SensorField> fields) {
  if (!reading.joints.empty()) return EncodeJoints(reading);
  if (reading.measured.index() != 0) return EncodeMeasurement(reading);
  std::string text = BeginAt(reading.at);
  text += R"(,"frame_id":"world","bodies":{)";
  for (const BodyReading& body : reading.bodies) {
    if (&body != &reading.bodies.front()) text += ',';
    text += Json(body.name).dump() + ":{";
    for (const SensorField& field : fields) {
      if (&field != &fields.front()) text += ',';
      text += '"';
      text += NameOf(field);
      text += "\":";
      AppendField(body, field, text);
    }
    text += '}';
  }
  return text += "}}";
}

std::string EncodeJoints(const Reading& reading) {
  std::string text = BeginAt(reading.at);
  text += R"(,"joints":{)";
  for (const JointReading& joint : reading.joints) {
    if (&joint != &reading.joints.front()) text += ',';
    text += Json(joint.name).dump() + R"(:{"position":)";
    AppendNumber(joint.state.position, text);
    text += R"(,"velocity":)";
    AppendNumber(joint.state.velocity, text);
    text += R"(,"effort":)";
    AppendNumber(joint.state.effort, text);
    text += '}';
  }
  return text += "}}";
}

std::variant<Wrench, DecodeError> DecodeCommand(std::string_view text) {
  if (const std::optional<Wrench> wrench = ReadPlainCommand(text)) return *wrench;
  const auto parsed = ParseObject(text, kExample);
  if (const auto* error = std::get_if<DecodeError>(&parsed)) return *error;
  Wrench wrench;
  for (const auto& [key, value] : std::get<Json>(parsed).items()) {
    const bool is_force = key == "force";
    if (!is_force && key != "torque") {
      return Mistake("has the unknown key " + Quote(key));
    }
    const auto vector = Vector3(value);
    if (!vector) return Mistake("has a " + key + " that is not a list of three finite numbers");
    (is_force ? wrench.force_n : wrench.torque_nm) = *vector;
  }
  return wrench;
}

namespace {

constexpr std::string_view kJointExample = R"({"elbow": 0.5})";

// Takes what `value` says of a joint into `goal`. Empty if `value` fits, else what is wrong with
// it.
std::string TakeGoal(const Json& value, JointQuantity quantity, JointGoal* goal) {
  if (const auto number = FiniteNumber(value)) {
    goal->Of(quantity) = *number;
    return {};
  }
  if (!value.is_object()) return "that is neither a finite number nor an object";
  for (const auto& [key, part] : value.items()) {
    const auto known = std::find(kJointQuantities.begin(), kJointQuantities.end(), key);
    if (known == kJointQuantities.end()) return "with the unknown key " + Quote(key);
    const auto number = FiniteNumber(part);
    if (!number) return "whose " + key + " is not a finite number";
    goal->Of(static_cast<JointQuantity>(known - kJointQuantities.begin())) = *number;
  }
  return {};
}

}  // namespace

std::variant<std::vector<JointGoal>, DecodeError> DecodeJointCommand(
    std::string_view text, std::span<const std::string> joints, JointQuantity quantity) {
  if (auto goals = ReadPlainGoals(text, joints, quantity)) return std::move(*goals);
  const auto parsed = ParseObject(text, kJointExample);
  if (const auto* error = std::get_if<DecodeError>(&parsed)) return *error;
  std::vector<JointGoal> goals;
  for (const auto& [key, value] : std::get<Json>(parsed).items()) {
    const auto found = std::find(joints.begin(), joints.end(), key);
    if (found == joints.end()) {
      return Mistake("names " + Quote(key) + ", which the channel does not drive", kJointExample);
    }
    JointGoal goal{static_cast<std::size_t>(found - joints.begin())};
    if (const std::string wrong = TakeGoal(value, quantity, &goal); !wrong.empty()) {
      return Mistake("has a value of " + Quote(key) + " " + wrong, kJointExample);
    }
    goals.push_back(goal);
  }
  return goals;
}

std::variant<PlanarSpeed, DecodeError> DecodeSpeed(std::string_view text) {
  constexpr std::string_view kSpeedExample = R"({"linear": [0.5, 0, 0], "angular": [0, 0, 0.1]})";
  const auto parsed = ParseObject(text, kSpeedExample);
  if (const auto* error = std::get_if<DecodeError>(&parsed)) return *error;
  PlanarSpeed speed;
  for (const auto& [key, value] : std::get<Json>(parsed).items()) {
    const bool is_linear = key == "linear";
    if (!is_linear && key != "angular") {
      return Mistake("has the unknown key " + Quote(key), kSpeedExample);
    }
    const auto vector = Vector3(value);
    if (!vector) {
      return Mistake("has a " + key + " that is not a list of three finite numbers", kSpeedExample);
    }
    (is_linear ? speed.forward_mps : speed.turn_radps) = is_linear ? (*vector)[0] : (*vector)[2];
  }
  return speed;
}

namespace {

constexpr std::string_view kTrajectoryExample =
    R"({"joints": ["elbow"], "points": [{"positions": [0.5], "time_from_start": 1.0}]})";

// Seconds, not before 0 and of at most some years.
std::optional<VirtualDuration> Seconds(const Json& value) {
  constexpr double kMost = 1e8;
  const auto number = FiniteNumber(value);
  if (!number || *number < 0 || *number > kMost) return std::nullopt;
  return VirtualDuration::Nanoseconds(std::llround(*number * 1e9));
}

std::optional<std::vector<double>> Numbers(const Json& value) {
  if (!value.is_array()) return std::nullopt;
  std::vector<double> numbers;
  for (const Json& each : value) {
    const auto number = FiniteNumber(each);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

// Takes a point into `point`. Empty on success, else what is wrong with it.
std::string TakePoint(const Json& value, JointTrajectory::Point* point) {
  if (!value.is_object() || !value.contains("positions") || !value.contains("time_from_start")) {
    return "has a point without positions or time_from_start";
  }
  for (const auto& [key, part] : value.items()) {
    if (key == "time_from_start") {
      const auto at = Seconds(part);
      if (!at) return "has a time_from_start that is no number of seconds";
      point->at = *at;
      continue;
    }
    if (key != "positions" && key != "velocities") {
      return "has a point with the unknown key " + Quote(key);
    }
    const auto numbers = Numbers(part);
    if (!numbers) return "has " + key + " that are not a list of finite numbers";
    (key == "positions" ? point->positions : point->velocities) = *numbers;
  }
  return {};
}

// The same, for the names of joints.
std::string TakeJoints(const Json& value, std::span<const std::string> joints,
                       std::vector<std::size_t>* places) {
  if (!value.is_array()) return "has joints that are not a list of names";
  for (const Json& name : value) {
    const auto found = name.is_string()
                           ? std::find(joints.begin(), joints.end(), name.get<std::string>())
                           : joints.end();
    if (found == joints.end()) {
      return "names the joint " + Quote(name.is_string() ? name.get<std::string>() : name.dump()) +
             ", which the channel does not drive";
    }
    const auto place = static_cast<std::size_t>(found - joints.begin());
    if (std::find(places->begin(), places->end(), place) != places->end()) {
      return "names the joint " + Quote(*found) + " twice";
    }
    places->push_back(place);
  }
  return {};
}

// The same, for one key of a trajectory.
std::string TakePart(const std::string& key, const Json& value, std::span<const std::string> joints,
                     JointTrajectory* trajectory) {
  if (key == "joints") return TakeJoints(value, joints, &trajectory->joints);
  if (key == "start") {
    const auto start = Seconds(value);
    if (!start) return "has a start that is no number of seconds";
    trajectory->start = VirtualTime{} + *start;
    return {};
  }
  if (key != "points") return "has the unknown key " + Quote(key);
  if (!value.is_array()) return "has points that are not a list";
  for (const Json& point : value) {
    std::string wrong = TakePoint(point, &trajectory->points.emplace_back());
    if (!wrong.empty()) return wrong;
  }
  return {};
}

}  // namespace

std::variant<JointTrajectory, DecodeError> DecodeTrajectory(std::string_view text,
                                                            std::span<const std::string> joints) {
  const auto parsed = ParseObject(text, kTrajectoryExample);
  if (const auto* error = std::get_if<DecodeError>(&parsed)) return *error;
  JointTrajectory trajectory;
  for (const auto& [key, value] : std::get<Json>(parsed).items()) {
    const std::string wrong = TakePart(key, value, joints, &trajectory);
    if (!wrong.empty()) return Mistake(wrong, kTrajectoryExample);
  }
  const std::string wrong = WhatIsWrongWith(trajectory);
  if (!wrong.empty()) return Mistake(wrong, kTrajectoryExample);
  return trajectory;
}

void TakeCommand(std::string_view what, std::string_view text, std::size_t channel,
                 const CommandSent& sent, CommandSink& sink) {
  const auto give = [&](const auto& decoded) {
    if (const auto* error = std::get_if<DecodeError>(&decoded)) {
      sink.Refuse(channel, std::string(what) + " " + error->message);
    } else {
      sink.Take(channel, sent, std::get<0>(decoded));
    }
  };
  const std::optional<GoalNames> goals = sink.GoalsOf(channel);
  if (goals && goals->are_wheels) {
    give(DecodeSpeed(text));
  } else if (goals && goals->follow_trajectories) {
    give(DecodeTrajectory(text, goals->Driven()));
  } else if (goals) {
    give(DecodeJointCommand(text, goals->names, goals->quantity));
  } else {
    give(DecodeCommand(text));
  }
}

}  // namespace tcs
