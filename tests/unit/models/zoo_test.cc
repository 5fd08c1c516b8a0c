// The robots of tests/models are read as they are meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simbody_bridge/model/model_check.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kTiny = 1e-12;

RobotModel Zoo(std::string_view name, bool has_fixed_base) {
  const Loaded loaded = LoadFile(ZooPath(name), {has_fixed_base});
  EXPECT_EQ(loaded.mistake, "");
  return loaded.model;
}

void ExpectNear(const std::array<double, 3>& a, const std::array<double, 3>& b,
                double within = kTiny) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], within) << i;
}

TEST(Zoo, ThePendulumHasItsBobAMetreBelowTheHinge) {
  const RobotModel model = Zoo("pendulum.urdf", true);
  EXPECT_EQ(model.name, "pendulum");
  EXPECT_TRUE(model.has_fixed_base);
  ASSERT_EQ(model.links.size(), 2u);
  EXPECT_EQ(model.links[0].name, "pivot");
  EXPECT_EQ(model.root, 0);
  EXPECT_FALSE(model.links[0].inertial.has_value());
  const Inertial& inertial = model.links[1].inertial.value();
  EXPECT_EQ(inertial.mass_kg, 1);
  ExpectNear(inertial.frame.position_m, {0, 0, -1});
  EXPECT_EQ(inertial.ixx_kgm2, 1e-4);
  ASSERT_EQ(model.joints.size(), 1u);
  const Joint& hinge = model.joints[0];
  EXPECT_EQ(hinge.kind, JointKind::kContinuous);
  EXPECT_EQ(hinge.parent, 0);
  EXPECT_EQ(hinge.child, 1);
  ExpectNear(hinge.axis, {0, 1, 0});
  EXPECT_EQ(hinge.limits.upper, kNoLimit);
  EXPECT_EQ(hinge.limits.effort, kNoLimit);
  const Shape& bob = model.links[1].shapes.at(0);
  EXPECT_EQ(bob.name, "bob");
  EXPECT_EQ(std::get<SphereShape>(bob.geometry).radius_m, 0.05);
  ExpectNear(bob.pose.position_m, {0, 0, -1});
}

TEST(Zoo, TheArmHasSixJointsWithTheirLimits) {
  const Loaded loaded = LoadFile(ZooPath("zoo_description/urdf/arm.urdf"), {true});
  ASSERT_EQ(loaded.mistake, "");
  const RobotModel& model = loaded.model;
  std::vector<std::string> names;
  for (const Joint& joint : model.joints) names.push_back(joint.name);
  EXPECT_THAT(names, ElementsAre("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2",
                                 "wrist_3"));
  const Joint& elbow = JointNamed(model, "elbow");
  EXPECT_EQ(elbow.kind, JointKind::kRevolute);
  EXPECT_EQ(elbow.limits.lower, -2.6);
  EXPECT_EQ(elbow.limits.upper, 2.6);
  EXPECT_EQ(elbow.limits.effort, 150);
  EXPECT_EQ(elbow.limits.velocity, 3.15);
  EXPECT_EQ(elbow.damping, 0.4);
  EXPECT_EQ(elbow.friction, 0.1);
  ExpectNear(elbow.origin.position_m, {0, -0.06, 0.42});
  // Looks are not said to be left out; what drives joints is.
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_THAT(loaded.warnings[0], HasSubstr("arm.urdf:166: <transmission> is not understood"));
}

TEST(Zoo, AnInertiaAlongTurnedAxesKeepsThem) {
  const RobotModel model = Zoo("zoo_description/urdf/arm.urdf", true);
  const Inertial& wrist = LinkNamed(model, "wrist_1_link").inertial.value();
  // Turned a quarter about x: the axis of the cylinder, z of the inertia, is -y of the link.
  ExpectNear(Rotate(wrist.frame.orientation_xyzw, {0, 0, 1}), {0, -1, 0});
  EXPECT_NEAR(wrist.izz_kgm2, 1.2 * 0.04 * 0.04 / 2, 1e-8);
}

TEST(Zoo, RollPitchAndYawAreAboutFixedAxes) {
  const RobotModel model = Zoo("every_joint.urdf", true);
  const Inertial& inertial = LinkNamed(model, "carriage").inertial.value();
  const double r = 0.1, p = 0.2, y = 0.3;
  ExpectNear(Rotate(inertial.frame.orientation_xyzw, {1, 0, 0}),
             {std::cos(y) * std::cos(p), std::sin(y) * std::cos(p), -std::sin(p)});
  ExpectNear(Rotate(inertial.frame.orientation_xyzw, {0, 0, 1}),
             {std::cos(y) * std::sin(p) * std::cos(r) + std::sin(y) * std::sin(r),
              std::sin(y) * std::sin(p) * std::cos(r) - std::cos(y) * std::sin(r),
              std::cos(p) * std::cos(r)});
  EXPECT_EQ(inertial.ixy_kgm2, 1e-4);
  EXPECT_EQ(inertial.ixz_kgm2, -2e-4);
  EXPECT_EQ(inertial.iyz_kgm2, 3e-4);
}

TEST(Zoo, EveryTypeOfJointIsTaken) {
  const RobotModel model = Zoo("every_joint.urdf", true);
  EXPECT_EQ(JointNamed(model, "slide").kind, JointKind::kPlanar);
  EXPECT_EQ(JointNamed(model, "slide").damping, 2);
  EXPECT_EQ(JointNamed(model, "slide").friction, 0.5);
  EXPECT_EQ(JointNamed(model, "rail").kind, JointKind::kPrismatic);
  EXPECT_EQ(JointNamed(model, "free").kind, JointKind::kFloating);
  EXPECT_EQ(JointNamed(model, "knob").kind, JointKind::kRevolute);
  ExpectNear(JointNamed(model, "knob").axis, {0, 0, 2});  // as it is written: any length
  EXPECT_EQ(JointNamed(model, "needle_joint").kind, JointKind::kContinuous);
  EXPECT_EQ(JointNamed(model, "needle_joint").limits.lower, -kNoLimit);
  EXPECT_EQ(JointNamed(model, "needle_joint").limits.effort, 0.01);
  EXPECT_EQ(JointNamed(model, "label_joint").kind, JointKind::kFixed);
}

TEST(Zoo, AJointMimicsAnotherOneByItsNumber) {
  const RobotModel model = Zoo("every_joint.urdf", true);
  const Mimic& mimic = JointNamed(model, "right_finger_joint").mimic.value();
  EXPECT_EQ(model.joints.at(static_cast<std::size_t>(mimic.joint)).name, "left_finger_joint");
  EXPECT_EQ(mimic.multiplier, 1);
  EXPECT_EQ(mimic.offset, 0.005);
}

TEST(Zoo, TheRoversRootHasNoMassAndIsFixedToWhatHas) {
  const Loaded loaded = LoadFile(ZooPath("rover.urdf"), {false});
  ASSERT_EQ(loaded.mistake, "");
  EXPECT_FALSE(loaded.model.has_fixed_base);
  EXPECT_EQ(loaded.model.links.at(static_cast<std::size_t>(loaded.model.root)).name,
            "base_footprint");
  const Joint& wheel = JointNamed(loaded.model, "left_wheel_joint");
  ExpectNear(Rotate(wheel.origin.orientation_xyzw, wheel.axis), {0, 1, 0});
  EXPECT_THAT(loaded.warnings, IsEmpty());
  EXPECT_EQ(LinkNamed(loaded.model, "left_wheel").shapes.at(0).friction, 1);
}

TEST(Zoo, TheQuadrotorAndTheQuadrupedHaveTheirJoints) {
  EXPECT_EQ(Zoo("quadrotor.urdf", false).joints.size(), 8u);
  const RobotModel quadruped = Zoo("quadruped.urdf", false);
  EXPECT_EQ(quadruped.joints.size(), 16u);
  // Its knees cannot be at 0: whoever uses it has to say where they start.
  EXPECT_THAT(CheckModel(quadruped).value().what, HasSubstr("lf_knee"));
}

TEST(Zoo, MeshesOfAllKindsBecomeTheSameHull) {
  const RobotModel arm = Zoo("zoo_description/urdf/arm.urdf", true);
  const RobotModel other = Zoo("every_joint.urdf", true);
  struct Use {
    const Shape& shape;
    std::array<double, 3> scale;
  };
  for (const Use& use : {Use{LinkNamed(arm, "tool0").shapes.at(0), {0.05, 0.05, 0.05}},
                         Use{LinkNamed(arm, "wrist_2_link").shapes.at(0), {0.08, 0.08, 0.08}},
                         Use{LinkNamed(other, "carriage").shapes.at(0), {0.1, 0.1, -0.1}}}) {
    const Mesh& mesh = *std::get<MeshShape>(use.shape.geometry).mesh;
    SCOPED_TRACE(mesh.name);
    // A prism of six corners: the dent is gone.
    ASSERT_EQ(mesh.vertices_m.size(), 6u);
    EXPECT_EQ(mesh.triangles.size(), 8u);
    double volume = 0;
    std::array<double, 3> sum{};
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto &p = mesh.vertices_m[a], &q = mesh.vertices_m[b], &r = mesh.vertices_m[c];
      volume += (p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                 p[2] * (q[0] * r[1] - q[1] * r[0])) /
                6;
    }
    for (const auto& vertex : mesh.vertices_m) {
      for (std::size_t i = 0; i < 3; ++i) sum[i] += vertex[i];
    }
    // Positive: the triangles show their fronts outside, also of what is mirrored.
    const auto& [sx, sy, sz] = use.scale;
    EXPECT_NEAR(volume, 0.5 * std::abs(sx * sy * sz), 1e-9);
    ExpectNear(sum, {2 * sx, 2 * sy, 3 * sz}, 1e-7);
  }
}

}  // namespace
}  // namespace tcs
