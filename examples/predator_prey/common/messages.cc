#include "examples/predator_prey/common/messages.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace predator_prey {
namespace {

using Json = nlohmann::json;

Json ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json ToJson(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

Eigen::Vector3d ToVector(const Json& json) {
  const auto a = json.get<std::array<double, 3>>();
  return {a[0], a[1], a[2]};
}

Eigen::Quaterniond ToQuaternion(const Json& json) {
  const auto a = json.get<std::array<double, 4>>();
  return {a[3], a[0], a[1], a[2]};
}

// The robot names its fields without units, as robots do; the planner's messages carry them.
BodyState BodyFromSensors(const Json& json) {
  return {.position_m = ToVector(json.at("position")),
          .orientation = ToQuaternion(json.at("orientation")),
          .linear_velocity_mps = ToVector(json.at("linear_velocity")),
          .angular_velocity_radps = ToVector(json.at("angular_velocity"))};
}

Json ToJson(const BodyState& body) {
  return {{"position_m", ToJson(body.position_m)},
          {"orientation_xyzw", ToJson(body.orientation)},
          {"linear_velocity_mps", ToJson(body.linear_velocity_mps)},
          {"angular_velocity_radps", ToJson(body.angular_velocity_radps)}};
}

BodyState ToBody(const Json& json) {
  return {.position_m = ToVector(json.at("position_m")),
          .orientation = ToQuaternion(json.at("orientation_xyzw")),
          .linear_velocity_mps = ToVector(json.at("linear_velocity_mps")),
          .angular_velocity_radps = ToVector(json.at("angular_velocity_radps"))};
}

Json ToJson(const PlanStep& step) {
  return {{"duration_s", step.duration_s},
          {"force_n", ToJson(step.control.force_n)},
          {"torque_nm", ToJson(step.control.torque_nm)},
          {"expected", ToJson(step.expected)}};
}

PlanStep ToStep(const Json& json) {
  return {.duration_s = json.at("duration_s"),
          .control = {.force_n = ToVector(json.at("force_n")),
                      .torque_nm = ToVector(json.at("torque_nm"))},
          .expected = ToBody(json.at("expected"))};
}

template <typename Read>
auto Decode(std::string_view text, Read read) -> std::optional<decltype(read(Json{}))> {
  try {
    return read(Json::parse(text));
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<SensorReading> DecodeSensorReading(std::string_view text) {
  return Decode(text, [](const Json& json) {
    const Json& bodies = json.at("bodies");
    return SensorReading{.time_s = json.at("time"),
                         .predator = BodyFromSensors(bodies.at("predator")),
                         .prey = BodyFromSensors(bodies.at("prey"))};
  });
}

std::string EncodeCommand(const Wrench& command) {
  return Json{{"force", ToJson(command.force_n)}, {"torque", ToJson(command.torque_nm)}}.dump();
}

std::string Encode(const PlanRequest& request) {
  return Json{{"request_id", request.id},
              {"predator", ToJson(request.predator)},
              {"prey", ToJson(request.prey)}}
      .dump();
}

std::optional<PlanRequest> DecodePlanRequest(std::string_view text) {
  return Decode(text, [](const Json& json) {
    return PlanRequest{.id = json.at("request_id"),
                       .predator = ToBody(json.at("predator")),
                       .prey = ToBody(json.at("prey"))};
  });
}

std::string Encode(const PlanReply& reply) {
  Json steps = Json::array();
  for (const PlanStep& step : reply.steps) steps.push_back(ToJson(step));
  return Json{{"request_id", reply.id},
              {"planning_time_s", reply.planning_time_s},
              {"states_explored", reply.states_explored},
              {"reaches_goal", reply.reaches_goal},
              {"plan_duration_s", reply.plan_duration_s},
              {"steps", std::move(steps)}}
      .dump();
}

std::optional<PlanReply> DecodePlanReply(std::string_view text) {
  return Decode(text, [](const Json& json) {
    PlanReply reply{.id = json.at("request_id"),
                    .planning_time_s = json.at("planning_time_s"),
                    .states_explored = json.at("states_explored"),
                    .reaches_goal = json.at("reaches_goal"),
                    .plan_duration_s = json.at("plan_duration_s")};
    for (const Json& step : json.at("steps")) reply.steps.push_back(ToStep(step));
    return reply;
  });
}

}  // namespace predator_prey
