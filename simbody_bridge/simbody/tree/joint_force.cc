#include "simbody_bridge/simbody/tree/joint_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simbody_bridge/simbody/tree/smooth.h"

namespace tcs {
namespace {

// A stop is a spring that alone would make the joint swing so fast, with critical damping.
constexpr double kStopRadps = 500;
// Over this depth a stop's damping sets in.
constexpr double kStopDepth = 2e-4;
// The time that it takes to notice a joint in a stop, or about to be in one.
constexpr double kNearStopS = 1e-3;

double StopForce(double depth, double speed_inwards, double inertia) {
  if (depth <= 0) return 0;
  const double stiffness = inertia * kStopRadps * kStopRadps;
  const double damping = 2 * inertia * kStopRadps * SmoothStep(depth / kStopDepth);
  return std::max(0.0, stiffness * depth + damping * speed_inwards);
}

}  // namespace

double TimeToStop(const Joint& joint, double position, double velocity) {
  const JointLimits& limits = joint.limits;
  if (velocity == 0) return std::numeric_limits<double>::infinity();
  const double gap = velocity > 0 ? limits.upper - position : position - limits.lower;
  return std::max(kNearStopS, gap / std::abs(velocity));
}

JointForce::JointForce(const Forest& forest, std::vector<SimTK::MobilizedBody> bodies,
                       const std::span<const Wrench>& acting)
    : ForestForce(forest, std::move(bodies), acting), inertia_(forest.joints.size(), 1) {}

void JointForce::Measure(const SimTK::SimbodyMatterSubsystem& matter, const SimTK::State& start) {
  SimTK::State state = start;
  matter.getSystem().realize(state, SimTK::Stage::Position);
  SimTK::Vector alone(state.getNU()), moved(state.getNU());
  for (std::size_t i = 0; i < forest_.joints.size(); ++i) {
    const ForestJoint& joint = forest_.joints[i];
    if (joint.body == kWorldBody) continue;
    const int u = BodyAt(joint.body).getFirstUIndex(state);
    alone = 0;
    alone[u] = 1;
    matter.multiplyByM(state, alone, moved);
    inertia_[i] = moved[u];
  }
}

void JointForce::Slopes(const SimTK::State& state, std::vector<double>* by_speed,
                        std::vector<double>* by_coordinate) const {
  const auto all = static_cast<std::size_t>(state.getNU());
  by_speed->assign(all, 0);
  by_coordinate->assign(all, 0);
  const std::size_t links = forest_.links.size();
  for (std::size_t i = 0; i < forest_.joints.size(); ++i) {
    if (forest_.joints[i].body == kWorldBody) continue;
    const Joint& joint = *forest_.joints[i].joint;
    const SimTK::MobilizedBody& body = BodyAt(forest_.joints[i].body);
    const auto first = static_cast<std::size_t>(body.getFirstUIndex(state));
    const auto count = static_cast<std::size_t>(body.getNumU(state));
    std::fill_n(by_speed->begin() + static_cast<std::ptrdiff_t>(first), count, joint.damping);
    if (count != 1) continue;
    const double q = state.getQ()[body.getFirstQIndex(state)];
    const double speed = state.getU()[static_cast<int>(first)];
    const JointLimits& limits = joint.limits;
    const JointDrive drive = DriveOfJoint(acting_, links, i);
    if (std::abs(EffortOf(drive, kNoLimit, q, speed)) < limits.effort) {
      (*by_speed)[first] += std::max(0.0, drive.damping);
      (*by_coordinate)[first] += std::max(0.0, drive.stiffness);
    }
    if (q < limits.lower || q > limits.upper) {
      (*by_speed)[first] += 2 * inertia_[i] * kStopRadps;
      (*by_coordinate)[first] += inertia_[i] * kStopRadps * kStopRadps;
    }
  }
}

void JointForce::FindDrives(const SimTK::State& state, std::vector<LimitedDrive>* drives) const {
  drives->clear();
  for (std::size_t i = 0; i < forest_.joints.size(); ++i) {
    if (forest_.joints[i].body == kWorldBody) continue;
    const SimTK::MobilizedBody& body = BodyAt(forest_.joints[i].body);
    if (body.getNumU(state) != 1) continue;
    const JointDrive drive = DriveOfJoint(acting_, forest_.links.size(), i);
    if (drive.stiffness <= 0 && drive.damping <= 0) continue;
    const int speed = body.getFirstUIndex(state);
    drives->push_back({static_cast<std::size_t>(speed), state.getQ()[body.getFirstQIndex(state)],
                       state.getU()[speed], drive, forest_.joints[i].joint->limits.effort});
  }
}

void JointForce::calcForce(const SimTK::State& state,
                           SimTK::Vector_<SimTK::SpatialVec>& /*body_forces*/,
                           SimTK::Vector_<SimTK::Vec3>& /*particle_forces*/,
                           SimTK::Vector& mobility_forces) const {
  const SimTK::Vector& all_q = state.getQ();
  const SimTK::Vector& all_u = state.getU();
  const std::size_t links = forest_.links.size();
  for (std::size_t i = 0; i < forest_.joints.size(); ++i) {
    if (forest_.joints[i].body == kWorldBody) continue;
    const Joint& joint = *forest_.joints[i].joint;
    const SimTK::MobilizedBody& body = BodyAt(forest_.joints[i].body);
    const int first = body.getFirstUIndex(state), count = body.getNumU(state);
    for (int u = first; u < first + count; ++u) mobility_forces[u] -= joint.damping * all_u[u];
    if (count != 1) continue;
    const double q = all_q[body.getFirstQIndex(state)], speed = all_u[first];
    const JointLimits& limits = joint.limits;
    mobility_forces[first] += EffortOf(DriveOfJoint(acting_, links, i), limits.effort, q, speed);
    mobility_forces[first] += StopForce(limits.lower - q, -speed, inertia_[i]);
    mobility_forces[first] -= StopForce(q - limits.upper, speed, inertia_[i]);
  }
}

}  // namespace tcs
