#include "examples/predator_prey/predator_planner/pursuit_space.h"

#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO3StateSpace.h>
#include <ompl/base/spaces/TimeStateSpace.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>

#include <memory>

namespace predator_prey {
namespace {

namespace ob = ompl::base;
namespace oc = ompl::control;

enum Part : unsigned {
  kPosition,
  kOrientation,
  kLinearVelocity,
  kAngularVelocity,
  kPreyPosition,
  kPreyVelocity,
  kTime,
};

// How much a difference in each part counts in the distance between two states.
constexpr double kPositionWeight = 1.0;
constexpr double kVelocityWeight = 0.3;
constexpr double kOtherWeight = 0.01;

ob::StateSpacePtr MakeVectorSpace(double bound) {
  auto space = std::make_shared<ob::RealVectorStateSpace>(3);
  space->setBounds(-bound, bound);
  return space;
}

double* Values(ob::State* state, Part part) {
  return state->as<ob::CompoundState>()->as<ob::RealVectorStateSpace::StateType>(part)->values;
}

Eigen::Vector3d Vector(const ob::State* state, Part part) {
  return Eigen::Vector3d(
      state->as<ob::CompoundState>()->as<ob::RealVectorStateSpace::StateType>(part)->values);
}

}  // namespace

ob::StateSpacePtr MakePursuitSpace(const SpaceOptions& options) {
  auto time = std::make_shared<ob::TimeStateSpace>();
  time->setBounds(0.0, options.horizon_s);

  auto space = std::make_shared<ob::CompoundStateSpace>();  // in the order of Part
  space->addSubspace(MakeVectorSpace(options.position_bound_m), kPositionWeight);
  space->addSubspace(std::make_shared<ob::SO3StateSpace>(), kOtherWeight);
  space->addSubspace(MakeVectorSpace(options.velocity_bound_mps), kVelocityWeight);
  space->addSubspace(MakeVectorSpace(options.angular_velocity_bound_radps), kOtherWeight);
  space->addSubspace(MakeVectorSpace(options.position_bound_m), kOtherWeight);
  space->addSubspace(MakeVectorSpace(options.velocity_bound_mps), kOtherWeight);
  space->addSubspace(time, kOtherWeight);
  space->lock();
  return space;
}

oc::ControlSpacePtr MakeWrenchSpace(const ob::StateSpacePtr& space, const SpaceOptions& options) {
  ob::RealVectorBounds bounds(6);
  for (unsigned axis = 0; axis < 3; ++axis) {
    bounds.setLow(axis, -options.max_force_n);
    bounds.setHigh(axis, options.max_force_n);
    bounds.setLow(axis + 3, -options.max_torque_nm);
    bounds.setHigh(axis + 3, options.max_torque_nm);
  }
  auto controls = std::make_shared<oc::RealVectorControlSpace>(space, 6);
  controls->setBounds(bounds);
  return controls;
}

Pursuit ReadState(const ob::State* state) {
  const auto* parts = state->as<ob::CompoundState>();
  const auto* q = parts->as<ob::SO3StateSpace::StateType>(kOrientation);
  return {.predator = {.position_m = Vector(state, kPosition),
                       .orientation = Eigen::Quaterniond(q->w, q->x, q->y, q->z),
                       .linear_velocity_mps = Vector(state, kLinearVelocity),
                       .angular_velocity_radps = Vector(state, kAngularVelocity)},
          .prey_position_m = Vector(state, kPreyPosition),
          .prey_velocity_mps = Vector(state, kPreyVelocity),
          .time_s = parts->as<ob::TimeStateSpace::StateType>(kTime)->position};
}

void WriteState(const Pursuit& pursuit, ob::State* state) {
  const auto write = [state](const Eigen::Vector3d& v, Part part) {
    Eigen::Map<Eigen::Vector3d>(Values(state, part)) = v;
  };
  write(pursuit.predator.position_m, kPosition);
  write(pursuit.predator.linear_velocity_mps, kLinearVelocity);
  write(pursuit.predator.angular_velocity_radps, kAngularVelocity);
  write(pursuit.prey_position_m, kPreyPosition);
  write(pursuit.prey_velocity_mps, kPreyVelocity);

  auto* parts = state->as<ob::CompoundState>();
  auto* q = parts->as<ob::SO3StateSpace::StateType>(kOrientation);
  q->x = pursuit.predator.orientation.x();
  q->y = pursuit.predator.orientation.y();
  q->z = pursuit.predator.orientation.z();
  q->w = pursuit.predator.orientation.w();
  parts->as<ob::TimeStateSpace::StateType>(kTime)->position = pursuit.time_s;
}

Wrench ReadControl(const oc::Control* control) {
  const double* values = control->as<oc::RealVectorControlSpace::ControlType>()->values;
  return {.force_n = Eigen::Vector3d(values), .torque_nm = Eigen::Vector3d(values + 3)};
}

}  // namespace predator_prey
