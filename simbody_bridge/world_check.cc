#include "simbody_bridge/world_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simbody_bridge/engines.h"
#include "simbody_bridge/model/finite.h"
#include "simbody_bridge/model/model_check.h"
#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

// A moment may not exceed the sum of the two others; flat bodies reach it, so rounding is forgiven.
bool SatisfiesTriangleInequality(const std::array<double, 3>& inertia) {
  const double sum = inertia[0] + inertia[1] + inertia[2];
  const double largest = *std::max_element(inertia.begin(), inertia.end());
  return largest <= (sum - largest) + 1e-12 * sum;
}

void CheckBody(const BodySpec& body) {
  if (!IsPositive(body.mass_kg)) {
    throw DynamicsError(fmt::format("body '{}': the mass must be positive and finite, but is {} kg",
                                    body.name, body.mass_kg));
  }
  const auto& inertia = body.inertia_kgm2;
  const auto moments = fmt::format("({}, {}, {}) kg m^2", inertia[0], inertia[1], inertia[2]);
  if (!std::all_of(inertia.begin(), inertia.end(), IsPositive)) {
    throw DynamicsError(fmt::format(
        "body '{}': the principal moments of inertia must be positive and finite, but are {}",
        body.name, moments));
  }
  if (!SatisfiesTriangleInequality(inertia)) {
    throw DynamicsError(fmt::format(
        "body '{}': no rigid body has the principal moments of inertia {}, because one of them "
        "exceeds the sum of the two others",
        body.name, moments));
  }
  if (!AllFinite(body.initial)) {
    throw DynamicsError(fmt::format("body '{}': the initial state must be finite", body.name));
  }
  const double norm = NormOf(body.initial.orientation_xyzw);
  if (std::abs(norm - 1) > kQuaternionNormTolerance) {
    throw DynamicsError(fmt::format(
        "body '{}': the initial orientation must be a unit quaternion, but its length is {}",
        body.name, norm));
  }
}

void CheckDrag(const BodySpec& body) {
  const DragSpec& drag = body.drag;
  for (const double factor : {drag.linear_nspm, drag.quadratic_ns2pm2, drag.angular_linear_nmsprad,
                              drag.angular_quadratic_nms2prad2}) {
    if (IsNonNegative(factor)) continue;
    throw DynamicsError(
        fmt::format("body '{}': each factor of the drag must be finite and not negative, but one "
                    "is {}",
                    body.name, factor));
  }
}

void CheckWind(const WindSpec& wind) {
  if (!AllFinite(wind.mean_mps)) throw DynamicsError("wind: its velocity must be finite");
  if (!IsNonNegative(wind.gusts_mps)) {
    throw DynamicsError(fmt::format(
        "wind: the gusts must be finite and not negative, but are {} m/s", wind.gusts_mps));
  }
  if (wind.gust_time <= VirtualDuration{}) {
    throw DynamicsError(fmt::format("wind: the time of the gusts must be more than 0, but is {} ns",
                                    wind.gust_time.ns()));
  }
}

void CheckRegion(const RegionSpec& region) {
  if (!IsPositive(region.half_extent_m)) {
    throw DynamicsError(fmt::format(
        "region: the half extent must be positive and finite, but is {} m", region.half_extent_m));
  }
  if (!IsNonNegative(region.stiffness_npm)) {
    throw DynamicsError(
        fmt::format("region: the stiffness must be finite and not negative, but is {} N/m",
                    region.stiffness_npm));
  }
  if (!IsNonNegative(region.damping_nspm)) {
    throw DynamicsError(
        fmt::format("region: the damping must be finite and not negative, but is {} N s/m",
                    region.damping_nspm));
  }
}

void CheckIntegrator(const IntegratorSpec& integrator) {
  if (integrator.fixed_step < VirtualDuration{}) {
    throw DynamicsError(fmt::format("integrator: the fixed step must not be negative, but is {} ns",
                                    integrator.fixed_step.ns()));
  }
  if (!TraitsOf(integrator.engine).has_integrators) return;  // only integrators have an accuracy
  if (!(integrator.accuracy > 0 && integrator.accuracy < 1)) {
    throw DynamicsError(fmt::format("integrator: the accuracy must lie between 0 and 1, but is {}",
                                    integrator.accuracy));
  }
}

}  // namespace

bool AllFinite(const BodyState& state) {
  return AllFinite(state.position_m) && AllFinite(state.orientation_xyzw) &&
         AllFinite(state.linear_velocity_mps) && AllFinite(state.angular_velocity_radps);
}

void CheckWorld(const WorldSpec& world) {
  for (const BodySpec& body : world.bodies) {
    CheckBody(body);
    CheckDrag(body);
  }
  CheckWind(world.wind);
  for (const RobotModel& model : world.models) {
    if (const auto fault = CheckModel(model)) {
      throw DynamicsError(fmt::format("model '{}': {}", model.name, fault->what));
    }
  }
  for (const Shape& fixture : world.fixtures) {
    if (const auto fault = CheckShape(fixture, true)) {
      throw DynamicsError(fmt::format("fixture '{}': {}", fixture.name, *fault));
    }
  }
  if (!AllFinite(world.gravity_mps2)) throw DynamicsError("gravity: it must be finite");
  if (world.has_region) CheckRegion(world.region);
  CheckIntegrator(world.integrator);
}

void CheckWrench(const std::string& body, const Wrench& wrench) {
  if (!AllFinite(wrench.force_n) || !AllFinite(wrench.torque_nm)) {
    throw DynamicsError(fmt::format("body '{}': a commanded wrench must be finite", body));
  }
  if (wrench.lag < VirtualDuration{}) {
    throw DynamicsError(
        fmt::format("body '{}': the lag of a command must not be negative, but is {} ns", body,
                    wrench.lag.ns()));
  }
}

}  // namespace tcs
