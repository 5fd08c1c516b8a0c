#include "simbody_bridge/simbody_model.h"

#include <cmath>

#include "simbody_bridge/region_force.h"

namespace tcs {
namespace {

SimTK::Vec3 ToVec3(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

SimbodyModel::SimbodyModel(const WorldSpec& world) {
  forces_.setNumberOfThreads(1);
  if (world.gravity_mps2 != std::array<double, 3>{}) {
    SimTK::Force::UniformGravity(forces_, matter_, ToVec3(world.gravity_mps2));
  }
  for (const BodySpec& body : world.bodies) AddBody(body);
  if (world.has_region) {
    SimTK::Force::Custom(forces_, new RegionForce(world.region, bodies_));  // Simbody owns it
  }
  initial_state_ = system_.realizeTopology();
  system_.realizeModel(initial_state_);
  for (int i = 0; i < body_count(); ++i) SetBody(initial_state_, i, world.bodies[i].initial);
}

void SimbodyModel::AddBody(const BodySpec& body) {
  const SimTK::MassProperties mass(body.mass_kg, SimTK::Vec3(0),
                                   SimTK::Inertia(ToVec3(body.inertia_kgm2)));
  bodies_.emplace_back(matter_.Ground(), SimTK::Body::Rigid(mass));
}

// A Free mobilizer's coordinates: the quaternion (w x y z) and the position; its speeds: the
// angular and the linear velocity; all in Ground's frame.
void SimbodyModel::SetBody(SimTK::State& state, int body, const BodyState& value) const {
  const auto& q = value.orientation_xyzw;
  const auto& p = value.position_m;
  const auto& w = value.angular_velocity_radps;
  const auto& v = value.linear_velocity_mps;
  bodies_[body].setQ(state, SimTK::Vec7(q[3], q[0], q[1], q[2], p[0], p[1], p[2]));
  bodies_[body].setU(state, SimTK::Vec6(w[0], w[1], w[2], v[0], v[1], v[2]));
}

// The coordinates themselves, not a rotation matrix turned back: the quaternion keeps its sign from
// one reading to the next. Simbody lets its length drift a little, so it is normalised here.
BodyState SimbodyModel::ReadBody(const SimTK::State& state, int body) const {
  const SimTK::Vec7& q = bodies_[body].getQ(state);
  const SimTK::Vec6& u = bodies_[body].getU(state);
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  BodyState value;
  value.position_m = {q[4], q[5], q[6]};
  value.orientation_xyzw = {q[1] / norm, q[2] / norm, q[3] / norm, q[0] / norm};
  value.linear_velocity_mps = {u[3], u[4], u[5]};
  value.angular_velocity_radps = {u[0], u[1], u[2]};
  return value;
}

void SimbodyModel::SetWrench(SimTK::State& state, int body, const Wrench& wrench) const {
  wrenches_.setOneBodyForce(state, bodies_[body],
                            SimTK::SpatialVec(ToVec3(wrench.torque_nm), ToVec3(wrench.force_n)));
}

}  // namespace tcs
