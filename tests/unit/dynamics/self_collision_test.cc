// Links of one model that collide, but for those that are to be ignored: also where links that are
// fixed to each other, one body of the engine, are told apart.
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

class SelfCollision : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, SelfCollision, testing::ValuesIn(ModelEngines()), NameOfEngine);

Shape ShapeAt(const Geometry& geometry, double x, double z) {
  return {.name = "", .geometry = geometry, .pose = {{x, 0, z}, {0, 0, 0, 1}}};
}

// A slide that falls past its base: a shelf is fixed to the world 2 m below. The carriage and the
// ball, which is fixed beside it, are one body; both are to land on the shelf.
RobotModel Lift(const std::vector<std::pair<int, int>>& ignored) {
  RobotModel model;
  model.name = "lift";
  model.has_fixed_base = true;
  model.has_self_collision = true;
  model.ignored_pairs = ignored;
  Link shelf{.name = "shelf", .inertial = {}, .shapes = {ShapeAt(BoxShape{{3, 3, 0.1}}, 0, -2)}};
  // Between the two, so that no joint joins what touches.
  Link guide = LinkOf("guide", MassAt(1, {}, 1));
  Link carriage = LinkOf("carriage", MassAt(1, {}, 0.1));
  carriage.shapes = {ShapeAt(SphereShape{0.06}, 0, 0)};
  Link ball = LinkOf("ball", MassAt(1, {0.5, 0, 0}, 0.1));
  ball.shapes = {ShapeAt(SphereShape{0.06}, 0.5, 0)};
  model.links = {shelf, guide, carriage, ball};
  model.joints = {JointOf("aside", JointKind::kPrismatic, 0, 1, {1, 0, 0}),
                  JointOf("down", JointKind::kPrismatic, 1, 2, {0, 0, 1}),
                  JointOf("beside", JointKind::kFixed, 2, 3, {})};
  return model;
}

double Height(const IntegratorSpec& spec, const std::vector<std::pair<int, int>>& ignored) {
  auto dynamics = MakeDynamics(WorldOf({Lift(ignored)}, spec));
  return ReadLink(*dynamics, 2, AtMs(2000)).pose.position_m[2];
}

TEST_P(SelfCollision, LinksThatNoJointJoinsMeet) {
  EXPECT_NEAR(Height(GetParam(), {}), -1.89, 1e-3);
}

TEST_P(SelfCollision, OfABodyOneLinkIsIgnoredAndTheOtherOneMeets) {
  EXPECT_NEAR(Height(GetParam(), {{0, 2}}), -1.89, 1e-3);
  EXPECT_NEAR(Height(GetParam(), {{0, 3}}), -1.89, 1e-3);
}

TEST_P(SelfCollision, WhatIsIgnoredPasses) {
  EXPECT_NEAR(Height(GetParam(), {{0, 2}, {0, 3}}), -kG * 2, 0.01);
}

}  // namespace
}  // namespace tcs
