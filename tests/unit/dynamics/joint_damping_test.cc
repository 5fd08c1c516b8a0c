// Joints' own damping and friction beside closed forms, from inertias of 1 kg m^2 to such as nine
// decades less: as exact, and in as many steps.
#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

constexpr int kDecades = 9;
constexpr double kTolerance = 1e-6;

class OwnDamping : public EveryModelEngine {
 protected:
  struct Joint1 {
    double damping = 0, friction = 0, effort = 0, speed = 0;
  };
  // A wheel without gravity.
  std::unique_ptr<Dynamics> Wheel(double inertia_kgm2, const Joint1& spec) const {
    RobotModel model;
    model.name = "wheel";
    model.has_fixed_base = true;
    model.links.push_back({.name = "base", .inertial = {}, .shapes = {}});
    model.links.push_back(LinkOf("rim", MassAt(1, {}, inertia_kgm2)));
    Joint axle = JointOf("axle", JointKind::kContinuous, 0, 1, {0, 0, 1});
    axle.damping = spec.damping;
    axle.friction = spec.friction;
    axle.initial_velocity = {spec.speed};
    model.joints.push_back(axle);
    WorldSpec world = WorldOf({model}, GetParam());
    world.gravity_mps2 = {};
    auto dynamics = MakeDynamics(world);
    if (spec.effort != 0) dynamics->Drive(0, {.effort = spec.effort}, AtMs(0));
    return dynamics;
  }

  template <class Position, class Velocity>
  void Compare(const Joint1& spec, const Position& position, const Velocity& velocity) const {
    std::int64_t most_steps = 0;
    for (int decade = 0; decade <= kDecades; ++decade) {
      const double inertia = std::pow(10.0, -decade);
      const auto dynamics = Wheel(inertia, spec);
      for (const int ms : {1, 3, 10, 77, 300, 1000, 2000}) {
        dynamics->AdvanceTo(AtMs(ms));
        const JointState state = ReadJoint(*dynamics, 0, AtMs(ms));
        const double t = 1e-3 * ms;
        EXPECT_NEAR(state.position, position(inertia, t), kTolerance) << inertia << " after " << t;
        EXPECT_NEAR(state.velocity, velocity(inertia, t), kTolerance) << inertia << " after " << t;
      }
      const std::int64_t steps = dynamics->work().steps;
      if (decade == 0) most_steps = 2 * steps + 50;
      EXPECT_LE(steps, most_steps) << inertia;
    }
  }
};

std::vector<IntegratorSpec> EnginesAndSteps() {
  std::vector<IntegratorSpec> engines = ModelEngines();
  engines.push_back({.fixed_step = VirtualDuration::Milliseconds(5)});
  return engines;
}

std::string NameOfSteps(const testing::TestParamInfo<IntegratorSpec>& info) {
  return NameOfEngine(info) + (info.param.fixed_step.ns() > 0 ? "Steps" : "");
}

INSTANTIATE_TEST_SUITE_P(Engines, OwnDamping, testing::ValuesIn(EnginesAndSteps()), NameOfSteps);

TEST_P(OwnDamping, LetsAJointRunOut) {
  constexpr double kDamping = 2, kSpeed = 3;
  Compare(
      {.damping = kDamping, .speed = kSpeed},
      [&](double inertia, double t) {
        return -kSpeed * inertia / kDamping * std::expm1(-kDamping / inertia * t);
      },
      [&](double inertia, double t) { return kSpeed * std::exp(-kDamping / inertia * t); });
}

TEST_P(OwnDamping, LimitsTheSpeedThatAnEffortLeadsTo) {
  constexpr double kDamping = 2, kEffort = 1;
  Compare(
      {.damping = kDamping, .effort = kEffort},
      [&](double inertia, double t) {
        const double rate = kDamping / inertia;
        return kEffort / kDamping * (t + std::expm1(-rate * t) / rate);
      },
      [&](double inertia, double t) {
        return -kEffort / kDamping * std::expm1(-kDamping / inertia * t);
      });
}

TEST_P(OwnDamping, OfFrictionBringsAJointToRest) {
  constexpr double kFriction = 2, kSpeed = 3;
  Compare(
      {.friction = kFriction, .speed = kSpeed},
      [&](double inertia, double t) {
        const double slows = kFriction / inertia, until = std::min(t, kSpeed / slows);
        return kSpeed * until - slows / 2 * until * until;
      },
      [&](double inertia, double t) { return std::max(0.0, kSpeed - kFriction / inertia * t); });
}

TEST_P(OwnDamping, AndFrictionTogetherDo) {
  constexpr double kDamping = 2, kFriction = 1, kSpeed = 3;
  const auto rest = [&](double inertia) {
    return inertia / kDamping * std::log1p(kSpeed * kDamping / kFriction);
  };
  const double towards = kFriction / kDamping;  // the speed that it would come to, backwards
  Compare(
      {.damping = kDamping, .friction = kFriction, .speed = kSpeed},
      [&](double inertia, double t) {
        const double until = std::min(t, rest(inertia)), rate = kDamping / inertia;
        return -towards * until - (kSpeed + towards) / rate * std::expm1(-rate * until);
      },
      [&](double inertia, double t) {
        if (t >= rest(inertia)) return 0.0;
        return (kSpeed + towards) * std::exp(-kDamping / inertia * t) - towards;
      });
}

TEST_P(OwnDamping, OfFrictionHoldsAJointUntilAnEffortIsMore) {
  for (int decade = 0; decade <= kDecades; ++decade) {
    const double inertia = std::pow(10.0, -decade);
    const auto dynamics = Wheel(inertia, {.damping = 0.5, .friction = 1, .effort = 0.99});
    dynamics->AdvanceTo(AtMs(500));
    EXPECT_NEAR(ReadJoint(*dynamics, 0, AtMs(500)).position, 0, 1e-12) << inertia;
    dynamics->Drive(0, {.effort = 1.5}, AtMs(500));
    dynamics->AdvanceTo(AtMs(2500));
    const double rate = 0.5 / inertia;
    EXPECT_NEAR(ReadJoint(*dynamics, 0, AtMs(2500)).position, 2 + std::expm1(-rate * 2) / rate,
                kTolerance)
        << inertia;
  }
}

}  // namespace
}  // namespace tcs
