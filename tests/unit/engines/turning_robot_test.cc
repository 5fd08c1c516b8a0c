// A robot on two wheels and a caster turns as its wheels roll, whatever their shape, and as its
// caster drags.
#include <cmath>

#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

constexpr double kWheelRadius = 0.033, kSeparation = 0.16;

class TurningRobot : public EveryModelEngine {
 protected:
  // 0.9 kg, with the friction of its caster, a ball.
  static RobotModel Robot(const Geometry& wheel, double friction) {
    RobotModel model;
    model.name = "robot";
    Link base = LinkOf("base", MassAt(0.825, {-0.01, 0, 0.05}, 1e-3));
    base.shapes.push_back(
        ShapeOf(SphereShape{0.01}, friction, {{-0.081, 0, -0.023}, {0, 0, 0, 1}}));
    model.links.push_back(base);
    for (int i = 0; i < 2; ++i) {
      Link link = LinkOf(i == 0 ? "left" : "right", MassAt(0.0285, {}, 2e-5));
      link.shapes.push_back(ShapeOf(wheel, 1, {{}, FromRollPitchYaw(kPi / 2, 0, 0)}));
      model.links.push_back(link);
      Joint joint = JointOf(link.name, JointKind::kContinuous, 0, i + 1, {0, 1, 0},
                            {0, (i == 0 ? 1 : -1) * kSeparation / 2, 0});
      joint.limits.effort = 0.05;
      model.joints.push_back(joint);
    }
    model.at.position_m = {0, 0, kWheelRadius};
    return model;
  }

  // By how much less it has turned than its wheels have rolled, at the end of one turn.
  double SlipOf(const Geometry& wheel, double friction) const {
    WorldSpec world = WorldOf({Robot(wheel, friction)}, GetParam());
    world.fixtures = {Floor(1)};
    const auto dynamics = MakeDynamics(world);
    double turned = 0, last = 0;
    for (int ms = 0; ms <= 12000; ms += 50) {
      dynamics->AdvanceTo(AtMs(ms));
      const auto& q = ReadLink(*dynamics, 0, AtMs(ms)).pose.orientation_xyzw;
      const std::array<double, 3> ahead = Rotate(q, {1, 0, 0});
      const double heading = std::atan2(ahead[1], ahead[0]);
      turned += std::remainder(heading - last, 2 * kPi);
      last = heading;
      if (ms != 500) continue;
      for (const int joint : {0, 1}) {
        dynamics->Drive(joint, {.damping = 1, .velocity = joint == 0 ? -1.2 : 1.2}, AtMs(ms));
      }
    }
    const double rolled = ReadJoint(*dynamics, 1, AtMs(12000)).position -
                          ReadJoint(*dynamics, 0, AtMs(12000)).position;
    EXPECT_GT(turned, 5) << "it has made most of a turn";
    return rolled * kWheelRadius / kSeparation - turned;
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, TurningRobot, testing::ValuesIn(ModelEngines()), NameOfEngine);

TEST_P(TurningRobot, FollowsItsWheelsThoughTheseAreWide) {
  EXPECT_NEAR(SlipOf(SphereShape{kWheelRadius}, 0), 0, 0.02);
  // If it turned round a rim of each wheel, these would be nearer to each other by an eighth.
  EXPECT_NEAR(SlipOf(CylinderShape{kWheelRadius, 0.018}, 0), 0, 0.09);
}

// The wheels hold it against what the caster drags.
TEST_P(TurningRobot, FollowsItsWheelsThoughItsCasterDrags) {
  EXPECT_NEAR(SlipOf(SphereShape{kWheelRadius}, 0.8), 0, 0.03);
}

}  // namespace
}  // namespace tcs
