#include "tests/bench/probe/explored.h"

#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <cstdint>
#include <memory>

namespace tcs::bench {

namespace {

namespace ob = ompl::base;

constexpr double kBoundM = 10.0;

// Everywhere but in a slab that parts the start from the goal.
bool IsFree(const ob::State* state) {
  const auto* pose = state->as<ob::SE3StateSpace::StateType>();
  return pose->getX() < 0.0 || pose->getX() > 2.0;
}

}  // namespace

double StatesExplored(double seconds) {
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(1);
  const auto space = std::make_shared<ob::SE3StateSpace>();
  ob::RealVectorBounds bounds(3);
  bounds.setLow(-kBoundM);
  bounds.setHigh(kBoundM);
  space->setBounds(bounds);

  ompl::geometric::SimpleSetup setup(space);
  std::uint64_t explored = 0;
  setup.setStateValidityChecker([&explored](const ob::State* state) {
    ++explored;
    return IsFree(state);
  });
  ob::ScopedState<ob::SE3StateSpace> start(space), goal(space);
  start->setXYZ(-5.0, 0.0, 0.0);
  start->rotation().setIdentity();
  goal->setXYZ(5.0, 0.0, 0.0);
  goal->rotation().setIdentity();
  setup.setStartAndGoalStates(start, goal);
  setup.setPlanner(std::make_shared<ompl::geometric::RRT>(setup.getSpaceInformation()));
  setup.solve(seconds);
  return static_cast<double>(explored);
}

}  // namespace tcs::bench
