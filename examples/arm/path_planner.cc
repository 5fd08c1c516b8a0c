#include "examples/arm/path_planner.h"

#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "examples/arm/collisions.h"
#include "examples/arm/timing.h"
#include "examples/common/ticks.h"

namespace arm {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

using State = ob::RealVectorStateSpace::StateType;

constexpr unsigned kShortenings = 3, kStands = 40;
constexpr double kStepRad = 0.06;  // between two stands that are looked at

Joints JointsOf(const ob::State* state) { return Joints(state->as<State>()->values); }

void Write(const Joints& joints, ob::State* state) {
  Eigen::Map<Joints>(state->as<State>()->values) = joints;
}

std::unique_ptr<og::SimpleSetup> MakeSetup() {
  ob::RealVectorBounds bounds(kJoints);
  for (unsigned i = 0; i < kJoints; ++i) {
    bounds.setLow(i, -kArm[i].most_rad);
    bounds.setHigh(i, kArm[i].most_rad);
  }
  auto space = std::make_shared<ob::RealVectorStateSpace>(kJoints);
  space->setBounds(bounds);
  auto setup = std::make_unique<og::SimpleSetup>(space);
  setup->setStateValidityChecker([](const ob::State* state) { return IsFree(JointsOf(state)); });
  setup->getSpaceInformation()->setStateValidityCheckingResolution(kStepRad /
                                                                   space->getMaximumExtent());
  setup->setPlanner(std::make_shared<og::RRTConnect>(setup->getSpaceInformation()));
  return setup;
}

// One way to one of the goals: found, shortened, and its corners rounded.
std::optional<std::vector<Joints>> OneWay(og::SimpleSetup& setup, const Joints& from,
                                          const std::vector<Joints>& goals, double until_s) {
  const auto& si = setup.getSpaceInformation();
  setup.clear();
  ob::ScopedState<> state(si);
  Write(from, state.get());
  setup.setStartState(state);
  auto there = std::make_shared<ob::GoalStates>(si);
  for (const Joints& goal : goals) {
    Write(goal, state.get());
    there->addState(state);
  }
  setup.setGoal(there);
  const double left_s = std::max(until_s - examples::Seconds(), 0.0);
  if (setup.solve(left_s) != ob::PlannerStatus::EXACT_SOLUTION) return std::nullopt;
  og::PathGeometric path = setup.getSolutionPath();
  for (unsigned i = 0; i < kShortenings; ++i) {
    path.interpolate(kStands);
    setup.getPathSimplifier()->reduceVertices(path, kStands, kStands / 2);
  }
  setup.getPathSimplifier()->smoothBSpline(path, 5);
  std::vector<Joints> way;
  for (const ob::State* at : path.getStates()) way.push_back(JointsOf(at));
  return way;
}

std::size_t Nearest(const std::vector<Joints>& goals, const Joints& to) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < goals.size(); ++i) {
    if ((goals[i] - to).norm() < (goals[nearest] - to).norm()) nearest = i;
  }
  return nearest;
}

}  // namespace

PathPlanner::PathPlanner(unsigned threads, unsigned tries) : tries_(tries) {
  for (unsigned i = 0; i < threads; ++i) setups_.push_back(MakeSetup());
}

std::optional<PathPlanner::Plan> PathPlanner::Find(const Joints& from,
                                                   const std::vector<Joints>& goals,
                                                   double until_s) {
  std::atomic<unsigned> begun = 0;
  std::mutex mutex;
  std::optional<Plan> best;
  const auto work = [&](og::SimpleSetup& setup) {
    while (begun++ < tries_ && examples::Seconds() < until_s) {
      const auto way = OneWay(setup, from, goals, until_s);
      if (!way || way->size() < 2) continue;
      Plan plan{Timed(*way), Nearest(goals, way->back())};
      const std::lock_guard lock(mutex);
      if (!best || plan.points.back().at_s < best->points.back().at_s) best = std::move(plan);
    }
  };
  std::vector<std::thread> threads;
  for (const auto& setup : setups_) threads.emplace_back(work, std::ref(*setup));
  for (std::thread& thread : threads) thread.join();
  return best;
}

}  // namespace arm
