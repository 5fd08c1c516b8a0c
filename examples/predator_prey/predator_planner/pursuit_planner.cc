#include "examples/predator_prey/predator_planner/pursuit_planner.h"

#include <ompl/base/ScopedState.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/control/planners/sst/SST.h>

#include <algorithm>

#include "examples/predator_prey/common/monotonic_clock.h"

namespace predator_prey {

namespace ob = ompl::base;
namespace oc = ompl::control;

PursuitPlanner::PursuitPlanner(const PlannerOptions& options)
    : options_(options),
      setup_(MakeWrenchSpace(MakePursuitSpace(options.space), options.space)),
      cost_(std::make_shared<TimeNearPrey>(setup_.getSpaceInformation())) {
  const oc::SpaceInformationPtr& si = setup_.getSpaceInformation();
  si->setPropagationStepSize(options.step_s);
  si->setMinMaxControlDuration(options.min_control_steps, options.max_control_steps);
  setup_.setStatePropagator(std::make_shared<PursuitPropagator>(si, options.model));
  setup_.setStateValidityChecker(
      [si = si.get()](const ob::State* state) { return si->satisfiesBounds(state); });
  setup_.setOptimizationObjective(cost_);

  const auto planner = std::make_shared<oc::SST>(si);
  planner->setGoalBias(options.goal_bias);
  planner->setSelectionRadius(options.selection_radius);
  planner->setPruningRadius(options.pruning_radius);
  setup_.setPlanner(planner);
}

void PursuitPlanner::SetProblem(const PlanRequest& request) {
  ob::ScopedState<> start(setup_.getStateSpace());
  WriteState({.predator = request.predator,
              .prey_position_m = request.prey.position_m,
              .prey_velocity_mps = request.prey.linear_velocity_mps},
             start.get());
  setup_.getSpaceInformation()->enforceBounds(start.get());

  setup_.clear();
  setup_.setStartState(start);
  setup_.setGoal(std::make_shared<PursuitGoal>(setup_.getSpaceInformation(), options_.goal,
                                               ReadState(start.get())));
}

ob::PlannerStatus PursuitPlanner::Solve() {
  if (options_.iterations == 0) return setup_.solve(options_.budget_s);
  ob::IterationTerminationCondition work(options_.iterations);
  return setup_.solve(work);
}

PlanReply PursuitPlanner::Plan(const PlanRequest& request) {
  const double begin_s = MonotonicSeconds();
  const std::uint64_t explored_before = cost_->motions();
  SetProblem(request);
  const ob::PlannerStatus status = Solve();

  PlanReply reply{.id = request.id, .states_explored = cost_->motions() - explored_before};
  reply.reaches_goal = status == ob::PlannerStatus::EXACT_SOLUTION;
  if (setup_.haveSolutionPath()) {
    const oc::PathControl& path = setup_.getSolutionPath();
    reply.plan_duration_s = path.length();
    reply.steps = Beginning(path);
  }
  reply.planning_time_s = MonotonicSeconds() - begin_s;
  return reply;
}

std::vector<PlanStep> PursuitPlanner::Beginning(oc::PathControl path) const {
  path.interpolate();  // one control and state each propagation step
  const auto wanted = static_cast<std::size_t>(options_.reply_s / options_.step_s + 0.5);
  std::vector<PlanStep> steps(std::min(wanted, path.getControlCount()));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto index = static_cast<unsigned>(i);
    steps[i] = {.duration_s = path.getControlDuration(index),
                .control = ReadControl(path.getControl(index)),
                .expected = ReadState(path.getState(index)).predator};
  }
  return steps;
}

}  // namespace predator_prey
