// The datagrams between the robots and their programs, and between controller and planner: one JSON
// object each. The fields are listed in README.md.
//
// Decoders return nothing for text that is not the message they expect: a datagram can come from
// anywhere, so a bad one is to be ignored, not to be died of.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "examples/predator_prey/common/body_state.h"

namespace predator_prey {

// Robot → controllers: both bodies as they were at `time_s`.
struct SensorReading {
  double time_s = 0.0;
  BodyState predator;
  BodyState prey;
};

// Controller → planner: plan from here. `id` comes back in the reply.
struct PlanRequest {
  std::uint64_t id = 0;
  BodyState predator;
  BodyState prey;
};

// A piece of a plan: the state it is expected to begin in, and the control held from there on.
struct PlanStep {
  double duration_s = 0.0;
  Wrench control;
  BodyState expected;
};

// Planner → controller: the beginning of the plan, empty if none was found.
struct PlanReply {
  std::uint64_t id = 0;
  double planning_time_s = 0.0;
  std::uint64_t states_explored = 0;
  bool reaches_goal = false;     // otherwise the plan is the one that came nearest
  double plan_duration_s = 0.0;  // of the whole plan
  std::vector<PlanStep> steps;
};

std::optional<SensorReading> DecodeSensorReading(std::string_view text);

std::string EncodeCommand(const Wrench& command);

std::string Encode(const PlanRequest& request);
std::optional<PlanRequest> DecodePlanRequest(std::string_view text);

std::string Encode(const PlanReply& reply);
std::optional<PlanReply> DecodePlanReply(std::string_view text);

}  // namespace predator_prey
