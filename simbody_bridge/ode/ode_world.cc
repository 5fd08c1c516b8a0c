#include "simbody_bridge/ode/ode_world.h"

#include <ode/ode.h>

#include "simbody_bridge/region_law.h"

namespace tcs {
namespace {

dBodyID MakeBody(dWorldID world, const BodySpec& spec) {
  const dBodyID body = dBodyCreate(world);
  dMass mass;
  const auto& inertia = spec.inertia_kgm2;
  dMassSetParameters(&mass, spec.mass_kg, 0, 0, 0, inertia[0], inertia[1], inertia[2], 0, 0, 0);
  dBodySetMass(body, &mass);
  // The body turns by the angle that the angular velocity makes in a step, not by its tangent.
  dBodySetFiniteRotationMode(body, 1);
  return body;
}

void Write(dBodyID body, const BodyState& state) {
  const auto& p = state.position_m;
  const auto& q = state.orientation_xyzw;
  const auto& v = state.linear_velocity_mps;
  const auto& w = state.angular_velocity_radps;
  const dQuaternion wxyz = {q[3], q[0], q[1], q[2]};
  dBodySetPosition(body, p[0], p[1], p[2]);
  dBodySetQuaternion(body, wxyz);
  dBodySetLinearVel(body, v[0], v[1], v[2]);
  dBodySetAngularVel(body, w[0], w[1], w[2]);
}

BodyState ReadBody(dBodyID body) {
  const dReal* p = dBodyGetPosition(body);
  const dReal* q = dBodyGetQuaternion(body);
  const dReal* v = dBodyGetLinearVel(body);
  const dReal* w = dBodyGetAngularVel(body);
  return {.position_m = {p[0], p[1], p[2]},
          .orientation_xyzw = {q[1], q[2], q[3], q[0]},
          .linear_velocity_mps = {v[0], v[1], v[2]},
          .angular_velocity_radps = {w[0], w[1], w[2]}};
}

}  // namespace

void OdeWorld::Destroy::operator()(dxWorld* world) const { dWorldDestroy(world); }

// Everything that ODE would do besides Newton and Euler stays off: damping, a limit of the angular
// speed, putting bodies at rest to sleep. These are ODE's defaults, but for the last, which is
// written down because a sleeping body would ignore commands.
OdeWorld::OdeWorld(const WorldSpec& world) : spec_(world), world_(dWorldCreate()) {
  if (!world_) throw DynamicsError("ODE cannot make its world; check whether memory is left");
  const auto& g = world.gravity_mps2;
  dWorldSetGravity(world_.get(), g[0], g[1], g[2]);
  dWorldSetAutoDisableFlag(world_.get(), 0);
  for (const BodySpec& body : world.bodies) bodies_.push_back(MakeBody(world_.get(), body));
}

// dWorldStep, not dWorldQuickStep: they differ only in how they solve for the forces of joints and
// contacts, of which there are none, and the former draws no random numbers for it.
void OdeWorld::Step(double seconds, const std::vector<Load>& loads,
                    std::vector<BodyState>* states) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const BodyState& state = (*states)[i];
    Write(bodies_[i], state);
    std::array<double, 3> force = loads[i].force_n;
    if (spec_.has_region) AddWallForce(spec_.region, state, &force);
    const auto& torque = loads[i].torque_nm;
    dBodySetForce(bodies_[i], force[0], force[1], force[2]);
    dBodySetTorque(bodies_[i], torque[0], torque[1], torque[2]);
  }
  if (dWorldStep(world_.get(), seconds) == 0) {
    throw DynamicsError("ODE cannot take its step; check whether memory is left");
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) (*states)[i] = ReadBody(bodies_[i]);
}

}  // namespace tcs
