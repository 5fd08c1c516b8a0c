// What is wrong with a model is said in one sentence that names it; what engines build from one.
#include "simbody_bridge/model/model_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "simbody_bridge/model/convex_hull.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

std::string FaultOf(const std::function<void(RobotModel&)>& spoil) {
  RobotModel model = Pendulum(2);
  spoil(model);
  const std::optional<ModelFault> fault = CheckModel(model);
  return fault.has_value() ? fault->what : "";
}

TEST(ModelCheck, FindsNothingWrongWithAPendulum) {
  EXPECT_EQ(FaultOf([](RobotModel&) {}), "");
}

TEST(ModelCheck, NamesWhatNoBodyCanHave) {
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.links[2].inertial.reset(); }),
            "link 'rod2' moves (joint 'hinge2' moves it) but has no mass: give it an inertial");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.has_fixed_base = false; }),
            "link 'base' moves (its base is free) but has no mass: give it an inertial");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.links[1].inertial->mass_kg = -1; }),
            "link 'rod1': its mass must be positive and finite, but is -1 kg");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.links[1].inertial->ixx_kgm2 = 0.05; }),
            "link 'rod1': no rigid body has its principal moments of inertia (0.01, 0.01, 0.05) kg "
            "m^2, because one of them exceeds the sum of the two others");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.links[1].inertial->ixy_kgm2 = 0.02; }),
            "link 'rod1': its principal moments of inertia must be positive, but are (-0.01, 0.01, "
            "0.03) kg m^2");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.links[1].inertial->iyz_kgm2 = kNan; }),
            "link 'rod1': its inertia must be finite");
}

TEST(ModelCheck, NamesWhatIsNoTree) {
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.links[2].name = "rod1"; }), "two links are named 'rod1'");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.joints[1].name = "hinge1"; }),
            "two joints are named 'hinge1'");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.joints[1].parent = 7; }),
            "joint 'hinge2': its parent link does not exist");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.joints.pop_back(); }),
            "no joint joins link 'rod2' to the rest: link 'base' is the root");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.joints[0].parent = 2; }),
            "the joints form a loop through link 'rod1', but a model is a tree");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.joints[1].child = 1; }),
            "link 'rod1' is the child of joint 'hinge1' and of joint 'hinge2', but a model is a "
            "tree");
  EXPECT_EQ(FaultOf([](RobotModel& m) { m.joints[1].child = 0; }),
            "joint 'hinge2' has the root 'base' as its child, so the joints form a loop");
}

TEST(ModelCheck, NamesWhatNoJointCanHave) {
  const auto fault = [](const std::function<void(Joint&)>& spoil) {
    return FaultOf([&](RobotModel& m) { spoil(m.joints[1]); });
  };
  EXPECT_EQ(fault([](Joint& j) {
              j.axis = {0, 0, 0};
            }),
            "joint 'hinge2': its axis has no direction");
  EXPECT_EQ(fault([](Joint& j) { j.limits = {.lower = 1, .upper = -1}; }),
            "joint 'hinge2': its lower limit 1 is not below its upper limit -1");
  EXPECT_EQ(fault([](Joint& j) {
              j.limits.upper = 1;
              j.initial_position = {2};
            }),
            "joint 'hinge2': its initial position 2 lies beyond its limits -inf and 1");
  EXPECT_EQ(fault([](Joint& j) { j.damping = -1; }),
            "joint 'hinge2': its damping must be finite and not negative, but is -1");
  EXPECT_EQ(fault([](Joint& j) { j.mimic = Mimic{1, 1, 0}; }), "joint 'hinge2': it follows itself");
  EXPECT_EQ(fault([](Joint& j) {
              j.mimic = Mimic{9, 1, 0};
            }),
            "joint 'hinge2': it follows a joint that does not exist");
}

TEST(ModelCheck, NamesWhatNoShapeCanHave) {
  const auto fault = [](const Geometry& geometry) {
    return FaultOf([&](RobotModel& m) {
      m.links[1].shapes.push_back({.name = "", .geometry = geometry, .pose = {}, .friction = 0.5});
    });
  };
  EXPECT_EQ(fault(SphereShape{-1}),
            "link 'rod1', shape 1: the radius must be positive and finite, but is -1 m");
  EXPECT_EQ(fault(PlaneShape{}),
            "link 'rod1', shape 1: a plane has no end, so it belongs to the world and to no link");
  auto flat = std::make_shared<Mesh>();
  flat->name = "leaf.stl";
  flat->vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  EXPECT_EQ(fault(MeshShape{flat}),
            "link 'rod1', shape 1: the mesh 'leaf.stl' encloses nothing: it is flat");
}

// A chain as long as hostile files have them takes no longer than its length, and no stack.
TEST(ModelCheck, TakesALongChain) {
  constexpr int kLong = 20'000;
  RobotModel model = Pendulum(1);
  for (int i = 1; i < kLong; ++i) {
    model.links.push_back(LinkOf("rod" + std::to_string(i + 1), MassAt(1, {}, 0.01)));
    model.joints.push_back(
        JointOf("hinge" + std::to_string(i + 1), JointKind::kFixed, i, i + 1, {0, 1, 0}));
  }
  EXPECT_FALSE(CheckModel(model).has_value());
}

TEST(ConvexHull, OfACubeWithPointsInsideIsTheCube) {
  std::vector<std::array<double, 3>> points;
  for (int i = 0; i < 8; ++i) {
    points.push_back({i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
  }
  for (int i = 0; i < 20; ++i) points.push_back({0.05 * i, 0.5, 0.02 * i});
  const auto hull = HullOf(points);
  ASSERT_TRUE(hull.has_value());
  EXPECT_EQ(hull->vertices.size(), 8u);
  EXPECT_EQ(hull->triangles.size(), 12u);
}

}  // namespace
}  // namespace tcs
