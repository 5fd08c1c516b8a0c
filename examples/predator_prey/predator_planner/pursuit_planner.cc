#include "examples/predator_prey/predator_planner/pursuit_planner.h"

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/control/PathControl.h>

#include <algorithm>
#include <utility>

#include "examples/predator_prey/common/periodic_timer.h"
#include "examples/predator_prey/predator_planner/time_near_prey.h"

namespace predator_prey {

namespace ob = ompl::base;
namespace oc = ompl::control;

PursuitPlanner::PursuitPlanner(const PlannerOptions& options) : options_(options) {
  const ob::StateSpacePtr space = MakePursuitSpace(options.space);
  si_ = std::make_shared<oc::SpaceInformation>(space, MakeWrenchSpace(space, options.space));
  si_->setStatePropagator(std::make_shared<PursuitPropagator>(si_, options.model));
  si_->setStateValidityChecker(
      [si = si_.get()](const ob::State* state) { return si->satisfiesBounds(state); });
  si_->setPropagationStepSize(options.step_s);
  si_->setMinMaxControlDuration(options.min_control_steps, options.max_control_steps);
  si_->setup();

  sst_ = std::make_unique<oc::SST>(si_);
  sst_->setGoalBias(options.goal_bias);
  sst_->setSelectionRadius(options.selection_radius);
  sst_->setPruningRadius(options.pruning_radius);
}

ob::ProblemDefinitionPtr PursuitPlanner::MakeProblem(const PlanRequest& request) const {
  const Pursuit start{.predator = request.predator,
                      .prey_position_m = request.prey.position_m,
                      .prey_velocity_mps = request.prey.linear_velocity_mps};
  ob::ScopedState<> start_state(si_);
  WriteState(start, start_state.get());
  si_->enforceBounds(start_state.get());

  auto problem = std::make_shared<ob::ProblemDefinition>(si_);
  problem->addStartState(start_state);
  problem->setGoal(std::make_shared<PursuitGoal>(si_, options_.goal, ReadState(start_state.get())));
  return problem;
}

PlanReply PursuitPlanner::Plan(const PlanRequest& request) {
  const double begin_s = MonotonicSeconds();
  const ob::ProblemDefinitionPtr problem = MakeProblem(request);
  const auto objective = std::make_shared<TimeNearPrey>(si_);
  problem->setOptimizationObjective(objective);
  sst_->clear();
  sst_->setProblemDefinition(problem);
  sst_->setup();
  const ob::PlannerStatus status =
      sst_->solve(ob::timedPlannerTerminationCondition(options_.budget_s));

  PlanReply reply{.id = request.id, .states_explored = objective->motions()};
  reply.reaches_goal = status == ob::PlannerStatus::EXACT_SOLUTION;
  if (const ob::PathPtr path = problem->getSolutionPath()) {
    const auto& controls = *path->as<oc::PathControl>();
    reply.plan_duration_s = controls.length();
    reply.steps = Beginning(controls);
  }
  reply.planning_time_s = MonotonicSeconds() - begin_s;
  return reply;
}

void PursuitPlanner::Forget() { sst_->clear(); }

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
