// Models at the edge of what engines bear: they move, or are refused in one sentence.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

class ExtremeModels : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, ExtremeModels, testing::ValuesIn(ModelEngines()), NameOfEngine);

// An arm of 1 kg with a tip, whose joint a servo holds.
RobotModel ArmWithTip(const Inertial& tip, double damping = 0, double friction = 0) {
  RobotModel model = Pendulum(1, 0.3, 1, 0.01);
  model.links.push_back(LinkOf("tip", tip));
  Joint joint = JointOf("tip", JointKind::kRevolute, 1, 2, {1, 0, 0}, {0, 0, -0.3});
  joint.limits = {.lower = -2, .upper = 2, .effort = 1};
  joint.damping = damping;
  joint.friction = friction;
  model.joints.push_back(joint);
  return model;
}

void ExpectMoves(Dynamics& dynamics, int joints, const std::string& what) {
  for (int ms = 0; ms <= 200; ms += 10) {
    dynamics.AdvanceTo(AtMs(ms));
    for (int joint = 0; joint < joints; ++joint) {
      const JointState state = ReadJoint(dynamics, joint, AtMs(ms));
      ASSERT_TRUE(std::isfinite(state.position) && std::abs(state.position) < 100) << what;
    }
  }
}

TEST_P(ExtremeModels, WithInertiasDownTo1em15Move) {
  for (int decade = 6; decade <= 15; ++decade) {
    for (const double damping : {0.0, 1e-3}) {
      for (const bool is_held : {false, true}) {
        const double inertia = std::pow(10.0, -decade);
        const auto dynamics = MakeDynamics(
            WorldOf({ArmWithTip(MassAt(std::max(1e-9, inertia), {}, inertia), damping, damping)},
                    GetParam()));
        if (is_held) {
          dynamics->Drive(1, {.stiffness = 1, .position = 0.5, .damping = 0.02}, AtMs(20));
        }
        ExpectMoves(*dynamics, 2, "1e-" + std::to_string(decade));
        if (!is_held) continue;
        EXPECT_NEAR(ReadJoint(*dynamics, 1, AtMs(200)).position, 0.5, 1e-2);
      }
    }
  }
}

TEST_P(ExtremeModels, ThatAreFlatOrRoundedMove) {
  for (const double beyond : {0.0, 1e-12, 1e-9, 9e-7}) {
    Inertial plate = MassAt(0.1, {0.01, 0, 0}, 1e-4);
    plate.frame.orientation_xyzw = FromRollPitchYaw(0.3, 0.4, 0.5);
    plate.izz_kgm2 = 2e-4 * (1 + beyond);
    const auto dynamics = MakeDynamics(WorldOf({ArmWithTip(plate)}, GetParam()));
    ExpectMoves(*dynamics, 2, std::to_string(beyond));
  }
}

TEST_P(ExtremeModels, WithAJointThatCannotMoveMove) {
  for (const double at : {0.0, 1.0}) {
    RobotModel model = ArmWithTip(MassAt(0.1, {0.01, 0, 0}, 1e-4));
    model.joints[1].limits.lower = model.joints[1].limits.upper = at;
    model.joints[1].initial_position = {at};
    const auto dynamics = MakeDynamics(WorldOf({model}, GetParam()));
    ExpectMoves(*dynamics, 2, std::to_string(at));
    EXPECT_NEAR(ReadJoint(*dynamics, 1, AtMs(200)).position, at, 1e-2);
  }
}

#ifdef TCS_HAS_MUJOCO
TEST(RefusedModels, AreNamedWithTheirJoint) {
  try {
    MakeDynamics(WorldOf({ArmWithTip(MassAt(1e-20, {}, 1e-6))}, {.engine = EngineKind::kMujoco}));
    ADD_FAILURE() << "accepted";
  } catch (const DynamicsError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("model 'pendulum': MuJoCo refuses it: what joint "
                                                  "'tip' moves: "));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
  }
}
#endif

}  // namespace
}  // namespace tcs
