// How far rays go until they meet something, against what geometry says.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "simbody_bridge/rays/ray_target.h"
#include "simbody_bridge/rays/scene.h"

namespace tcs {
namespace {

constexpr double kExact = 1e-12;
using Vector = std::array<double, 3>;

Vector Unit(const Vector& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

double Meet(const Geometry& geometry, const Vector& from, const Vector& along) {
  return RayTarget(geometry).Meet({from, Unit(along)});
}

MeshShape CubeMesh(double half) {
  auto mesh = std::make_shared<Mesh>();
  for (const double x : {-half, half}) {
    for (const double y : {-half, half}) {
      for (const double z : {-half, half}) mesh->vertices_m.push_back({x, y, z});
    }
  }
  return {mesh};
}

TEST(Rays, MeetTheNearSideOfABox) {
  const BoxShape box{{2, 4, 6}};
  EXPECT_NEAR(Meet(box, {-5, 0, 0}, {1, 0, 0}), 4, kExact);
  EXPECT_NEAR(Meet(box, {0, 5, 0}, {0, -1, 0}), 3, kExact);
  EXPECT_NEAR(Meet(box, {-2, 0, 0}, {1, 1, 0}), std::numbers::sqrt2, kExact);
  EXPECT_EQ(Meet(box, {-5, 2.001, 0}, {1, 0, 0}), kMeetsNothing);
  EXPECT_EQ(Meet(box, {-5, 0, 0}, {-1, 0, 0}), kMeetsNothing);
}

TEST(Rays, MeetABall) {
  const SphereShape ball{0.5};
  EXPECT_NEAR(Meet(ball, {3, 0, 0}, {-1, 0, 0}), 2.5, kExact);
  EXPECT_NEAR(Meet(ball, {3, 0.3, 0}, {-1, 0, 0}), 2.6, kExact);
  EXPECT_EQ(Meet(ball, {3, 0.500001, 0}, {-1, 0, 0}), kMeetsNothing);
}

TEST(Rays, MeetACylinderOnItsSideAndItsEnds) {
  const CylinderShape cylinder{0.5, 2};
  EXPECT_NEAR(Meet(cylinder, {3, 0.3, 0}, {-1, 0, 0}), 2.6, kExact);
  EXPECT_NEAR(Meet(cylinder, {0.2, 0.1, 5}, {0, 0, -1}), 4, kExact);
  EXPECT_NEAR(Meet(cylinder, {2, 0, 0}, {-1, 0, 0.5}), 1.5 * std::hypot(1, 0.5), kExact);
  EXPECT_EQ(Meet(cylinder, {3, 0, 1.01}, {-1, 0, 0}), kMeetsNothing);
  EXPECT_EQ(Meet(cylinder, {0.51, 0, 5}, {0, 0, -1}), kMeetsNothing);
}

TEST(Rays, MeetACapsuleAlsoOnItsBalls) {
  const CapsuleShape capsule{0.5, 2};
  EXPECT_NEAR(Meet(capsule, {0, 0, 5}, {0, 0, -1}), 3.5, kExact);
  EXPECT_NEAR(Meet(capsule, {3, 0, 0.7}, {-1, 0, 0}), 2.5, kExact);
  EXPECT_NEAR(Meet(capsule, {3, 0, 1.3}, {-1, 0, 0}), 2.6, kExact);
  EXPECT_EQ(Meet(capsule, {3, 0, 1.51}, {-1, 0, 0}), kMeetsNothing);
}

TEST(Rays, MeetAPlaneFromAboveOnly) {
  EXPECT_NEAR(Meet(PlaneShape{}, {7, 8, 3}, {1, 0, -1}), 3 * std::numbers::sqrt2, kExact);
  EXPECT_EQ(Meet(PlaneShape{}, {0, 0, 3}, {1, 0, 0}), kMeetsNothing);
  EXPECT_EQ(Meet(PlaneShape{}, {0, 0, -1}, {0, 0, 1}), kMeetsNothing);
}

TEST(Rays, ThatBeginInsideMeetNothing) {
  EXPECT_EQ(Meet(BoxShape{{1, 1, 1}}, {}, {1, 0, 0}), kMeetsNothing);
  EXPECT_EQ(Meet(SphereShape{1}, {0.9, 0, 0}, {1, 0, 0}), kMeetsNothing);
  EXPECT_EQ(Meet(CylinderShape{1, 1}, {}, {0, 0, 1}), kMeetsNothing);
  EXPECT_EQ(Meet(CapsuleShape{0.5, 2}, {}, {0, 0, 1}), kMeetsNothing);
  EXPECT_EQ(Meet(CubeMesh(1), {}, {1, 2, 3}), kMeetsNothing);
}

// A mesh of a cube's corners is that cube, from wherever it is looked at.
TEST(Rays, MeetAMeshAsItsHull) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-3, 3);
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector from = {anywhere(random), anywhere(random), anywhere(random)};
    const Vector along = Unit({anywhere(random), anywhere(random), anywhere(random)});
    const double of_box = Meet(BoxShape{{2, 2, 2}}, from, along);
    const double of_mesh = Meet(CubeMesh(1), from, along);
    if (of_box == kMeetsNothing) {
      EXPECT_EQ(of_mesh, kMeetsNothing);
    } else {
      EXPECT_NEAR(of_mesh, of_box, 1e-9);
      ++met;
    }
  }
  EXPECT_GT(met, 200);
}

RobotModel Block(const std::string& name, double size_m) {
  RobotModel model;
  model.name = name;
  Link link;
  link.name = name;
  link.inertial = Inertial{.mass_kg = 1, .frame = {}, .ixx_kgm2 = 1, .iyy_kgm2 = 1, .izz_kgm2 = 1};
  Shape shape;
  shape.geometry = BoxShape{{size_m, size_m, size_m}};
  shape.pose.position_m = {0, 0, 1};
  link.shapes.push_back(shape);
  model.links.push_back(link);
  return model;
}

TEST(Rays, MeetWhatIsInAWorldWhereItIs) {
  WorldSpec world;
  world.models = {Block("eye", 0.2), Block("other", 1)};
  Shape wall;
  wall.geometry = BoxShape{{0.2, 10, 10}};
  wall.pose.position_m = {5, 0, 0};
  world.fixtures.push_back(wall);
  Scene scene(world, 0);
  ASSERT_EQ(scene.links().size(), 1u);  // the sensor's own link is not seen
  EXPECT_EQ(scene.links()[0], 1);
  // The block is turned by 45 degrees about z, so that an edge looks here.
  const Pose pose{{3, 0, -1}, FromRollPitchYaw(0, 0, std::numbers::pi / 4)};
  scene.Place({&pose, 1});
  EXPECT_NEAR(scene.Cast({{0, 0, 0}, {1, 0, 0}}), 3 - std::numbers::sqrt2 / 2, kExact);
  EXPECT_NEAR(scene.Cast({{0, 1, 0}, {1, 0, 0}}), 4.9, kExact);
  EXPECT_EQ(scene.Cast({{0, 0, 0}, {-1, 0, 0}}), kMeetsNothing);
}

}  // namespace
}  // namespace tcs
