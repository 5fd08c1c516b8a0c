// Whether shapes touch, against what geometry says.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "simbody_bridge/touch/convex.h"
#include "simbody_bridge/touch/touching.h"

namespace tcs {
namespace {

Pose At(double x, double y = 0, double z = 0) { return {{x, y, z}, {0, 0, 0, 1}}; }

bool Touch(const Geometry& a, const Pose& pose_a, const Geometry& b, const Pose& pose_b,
           double margin_m = 0) {
  return AreWithin(PlacedConvex(a, pose_a), PlacedConvex(b, pose_b), margin_m);
}

TEST(Touch, BallsTouchWhereTheirRadiiReach) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-2, 2);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pose pose = At(anywhere(random), anywhere(random), anywhere(random));
    const auto [x, y, z] = pose.position_m;
    const double gap = std::hypot(x, y, z) - 1.5;
    if (std::abs(gap) < 1e-6) continue;
    const bool found = Touch(SphereShape{1}, At(0), SphereShape{0.5}, pose);
    EXPECT_EQ(found, gap < 0) << gap;
    touching += found ? 1 : 0;
  }
  EXPECT_GT(touching, 200);
}

TEST(Touch, BoxesThatAreTurnedTouchWithTheirEdges) {
  const BoxShape box{{1, 1, 1}};
  const Pose turned{{0.5 + std::numbers::sqrt2 / 2, 0, 0},
                    FromRollPitchYaw(0, 0, std::numbers::pi / 4)};
  Pose nearer = turned, farther = turned;
  nearer.position_m[0] -= 1e-6;
  farther.position_m[0] += 1e-6;
  EXPECT_TRUE(Touch(box, At(0), box, nearer));
  EXPECT_FALSE(Touch(box, At(0), box, farther));
  EXPECT_TRUE(Touch(box, At(0), box, farther, 2e-6));
}

TEST(Touch, CylindersCapsulesAndMeshesReachAsFarAsTheyAre) {
  const CylinderShape cylinder{0.5, 2};
  EXPECT_TRUE(Touch(cylinder, At(0), BoxShape{{1, 1, 1}}, At(0.999)));
  EXPECT_FALSE(Touch(cylinder, At(0), BoxShape{{1, 1, 1}}, At(1.001)));
  EXPECT_TRUE(Touch(cylinder, At(0), SphereShape{0.5}, At(0, 0, 1.499)));
  EXPECT_FALSE(Touch(cylinder, At(0), SphereShape{0.5}, At(0, 0, 1.501)));
  EXPECT_TRUE(Touch(CapsuleShape{0.5, 2}, At(0), SphereShape{0.5}, At(0, 0, 1.999)));
  EXPECT_FALSE(Touch(CapsuleShape{0.5, 2}, At(0), SphereShape{0.5}, At(0, 0, 2.001)));
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  // Beyond the slanted side, whose distance from the origin is 1 / sqrt 3.
  const double third = 1 / 3.0, unit = std::sqrt(third);
  const auto away = [&](double gap) {
    const double along = third + unit * (0.25 + gap);
    return At(along, along, along);
  };
  EXPECT_TRUE(Touch(MeshShape{mesh}, At(0), SphereShape{0.25}, away(-1e-4)));
  EXPECT_FALSE(Touch(MeshShape{mesh}, At(0), SphereShape{0.25}, away(1e-4)));
}

TEST(Touch, APlaneIsTouchedByWhatComesDownToIt) {
  const BoxShape box{{1, 1, 1}};
  EXPECT_TRUE(IsWithin(PlacedConvex(box, At(7, 8, 0.499)), {}, 0));
  EXPECT_FALSE(IsWithin(PlacedConvex(box, At(7, 8, 0.501)), {}, 0));
  EXPECT_TRUE(IsWithin(PlacedConvex(box, At(7, 8, 0.501)), {}, 0.002));
}

TEST(Touch, ALinkTouchesOthersAndNotItsOwnRobot) {
  WorldSpec world;
  RobotModel robot;
  for (const char* name : {"base", "arm"}) {
    Link link;
    link.name = name;
    Shape shape;
    shape.geometry = SphereShape{0.5};
    link.shapes.push_back(shape);
    robot.links.push_back(link);
  }
  world.models = {robot, robot};
  const Touching touching(world, 1);
  ASSERT_EQ(touching.links().size(), 3u);
  EXPECT_EQ(touching.links()[0], 1);
  EXPECT_EQ(touching.links()[1], 2);
  const std::array<Pose, 3> apart = {At(0), At(2), At(-2)}, near = {At(0), At(2), At(-0.9)};
  EXPECT_FALSE(touching.Touches(apart, 1e-3));
  EXPECT_TRUE(touching.Touches(near, 1e-3));
}

}  // namespace
}  // namespace tcs
