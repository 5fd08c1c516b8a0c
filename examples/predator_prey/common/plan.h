// What the predator's controller and planner exchange.
#pragma once

#include <cstdint>
#include <vector>

#include "examples/predator_prey/common/body_state.h"

namespace predator_prey {

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

}  // namespace predator_prey
