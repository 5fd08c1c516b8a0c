#include "examples/predator_prey/prey_controller/json_messages.h"

#include <array>
#include <nlohmann/json.hpp>

namespace predator_prey {
namespace {

using Json = nlohmann::json;

Json ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d ToVector(const Json& json) {
  const auto a = json.get<std::array<double, 3>>();
  return {a[0], a[1], a[2]};
}

Eigen::Quaterniond ToQuaternion(const Json& json) {
  const auto a = json.get<std::array<double, 4>>();
  return {a[3], a[0], a[1], a[2]};
}

BodyState ToBody(const Json& json) {
  return {.position_m = ToVector(json.at("position")),
          .orientation = ToQuaternion(json.at("orientation")),
          .linear_velocity_mps = ToVector(json.at("linear_velocity")),
          .angular_velocity_radps = ToVector(json.at("angular_velocity"))};
}

}  // namespace

std::optional<SensorReading> DecodeSensorReading(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    const Json& bodies = json.at("bodies");
    return SensorReading{.time_s = json.at("time"),
                         .predator = ToBody(bodies.at("predator")),
                         .prey = ToBody(bodies.at("prey"))};
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::string EncodeCommand(const Wrench& command) {
  return Json{{"force", ToJson(command.force_n)}, {"torque", ToJson(command.torque_nm)}}.dump();
}

}  // namespace predator_prey
