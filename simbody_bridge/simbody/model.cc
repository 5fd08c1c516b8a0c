#include "simbody_bridge/simbody/model.h"

#include <algorithm>
#include <array>

#include "simbody_bridge/model/vectors.h"
#include "simbody_bridge/simbody/region_force.h"
#include "simbody_bridge/simbody/vectors.h"

namespace tcs {

SimbodyModel::SimbodyModel(const WorldSpec& world, const std::vector<int>& bodies) {
  forces_.setNumberOfThreads(1);
  if (world.gravity_mps2 != std::array<double, 3>{}) {
    SimTK::Force::UniformGravity(forces_, matter_, ToVec3(world.gravity_mps2));
  }
  for (const int body : bodies) AddBody(world.bodies[static_cast<std::size_t>(body)]);
  if (world.has_region) {
    SimTK::Force::Custom(forces_, new RegionForce(world.region, bodies_));  // Simbody owns it
  }
  varying_ = new VaryingForce(bodies_);
  SimTK::Force::Custom(forces_, varying_);
  blank_state_ = system_.realizeTopology();
  system_.realizeModel(blank_state_);
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

void SimbodyModel::SetLoad(SimTK::State& state, int body, const Load& load) const {
  loads_.setOneBodyForce(state, bodies_[body],
                         SimTK::SpatialVec(ToVec3(load.torque_nm), ToVec3(load.force_n)));
}

// The coordinates themselves, not a rotation matrix turned back: the quaternion keeps its sign from
// one reading to the next. Simbody lets its length drift a little, so it is normalised here.
BodyState ReadBody(std::span<const double> continuous, int body_count, int body) {
  const auto bodies = static_cast<std::size_t>(body_count), i = static_cast<std::size_t>(body);
  const double* q = &continuous[kFreeBodyCoordinates * i];
  const double* u = &continuous[kFreeBodyCoordinates * bodies + kFreeBodySpeeds * i];
  const double norm = NormOf(std::span<const double, 4>(q, 4));
  BodyState value;
  value.position_m = {q[4], q[5], q[6]};
  value.orientation_xyzw = {q[1] / norm, q[2] / norm, q[3] / norm, q[0] / norm};
  value.linear_velocity_mps = {u[3], u[4], u[5]};
  value.angular_velocity_radps = {u[0], u[1], u[2]};
  return value;
}

void WriteBody(const BodyState& value, int body_count, int body, std::span<double> continuous) {
  const auto bodies = static_cast<std::size_t>(body_count), i = static_cast<std::size_t>(body);
  const auto& [x, y, z, w] = value.orientation_xyzw;
  double* q = &continuous[kFreeBodyCoordinates * i];
  double* u = &continuous[kFreeBodyCoordinates * bodies + kFreeBodySpeeds * i];
  q = std::copy_n(std::array{w, x, y, z}.begin(), 4, q);
  std::copy(value.position_m.begin(), value.position_m.end(), q);
  u = std::copy(value.angular_velocity_radps.begin(), value.angular_velocity_radps.end(), u);
  std::copy(value.linear_velocity_mps.begin(), value.linear_velocity_mps.end(), u);
}

void NormaliseQuaternions(std::span<double> continuous, int body_count) {
  for (int body = 0; body < body_count; ++body) {
    Normalise(continuous.subspan(kFreeBodyCoordinates * static_cast<std::size_t>(body)).first<4>());
  }
}

}  // namespace tcs
