// Plans the predator's pursuit with OMPL's SST, which improves its plan until the budget is used
// up.
//
// For one thread; OMPL starts another one that watches the clock when the budget is 1 s or more.
// Call ompl::RNG::setSeed before the first one is made to have the same random numbers every time.
#pragma once

#include <ompl/control/SimpleSetup.h>

#include <memory>

#include "examples/predator_prey/common/plan.h"
#include "examples/predator_prey/predator_planner/pursuit_goal.h"
#include "examples/predator_prey/predator_planner/pursuit_propagator.h"
#include "examples/predator_prey/predator_planner/pursuit_space.h"
#include "examples/predator_prey/predator_planner/time_near_prey.h"

namespace predator_prey {

struct PlannerOptions {
  double budget_s = 1.0;
  unsigned iterations = 0;  // when not 0, the budget instead: so much work, however long it takes
  double reply_s = 0.2;     // how much of the plan is given away
  double step_s = 0.01;     // of propagation
  unsigned min_control_steps = 10;
  unsigned max_control_steps = 30;
  double goal_bias = 0.2;
  double selection_radius = 0.5;
  double pruning_radius = 0.3;
  SpaceOptions space;
  ModelOptions model;
  GoalOptions goal;
};

class PursuitPlanner {
 public:
  explicit PursuitPlanner(const PlannerOptions& options);

  // Plans for the whole budget.
  PlanReply Plan(const PlanRequest& request);

  // Frees what the last plan needed. The next plan would do it, at its own expense of time.
  void Forget() { setup_.clear(); }

 private:
  void SetProblem(const PlanRequest& request);
  ompl::base::PlannerStatus Solve();
  std::vector<PlanStep> Beginning(ompl::control::PathControl path) const;

  PlannerOptions options_;
  ompl::control::SimpleSetup setup_;
  std::shared_ptr<TimeNearPrey> cost_;
};

}  // namespace predator_prey
