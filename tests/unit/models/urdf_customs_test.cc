// What files of the field have beside the letter of URDF is read as other tools read it, and said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/models/mend_masses.h"
#include "simbody_bridge/model/model_check.h"
#include "simbody_bridge/model/rigid_tree.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// An arm that a joint `j` moves; `rest` may have more.
std::string Arm(std::string_view joint, std::string_view rest = "") {
  return "<robot name='r'><link name='base'/><link name='arm'><inertial><mass value='1'/><inertia "
         "ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link>\n" +
         std::string(joint) + "\n" + std::string(rest) + "</robot>";
}

std::string JointOf(std::string_view type, std::string_view inside) {
  return "<joint name='j' type='" + std::string(type) +
         "'><parent link='base'/><child link='arm'/><axis xyz='0 1 0'/>" + std::string(inside) +
         "</joint>";
}

// A second link `tip` of `inertial` that the joint `k` joins to the arm.
std::string Tip(std::string_view type, std::string_view inertial, std::string_view inside = "") {
  return "<link name='tip'>" + std::string(inertial) + "</link><joint name='k' type='" +
         std::string(type) + "'><parent link='arm'/><child link='tip'/>" + std::string(inside) +
         "</joint>";
}

std::string InertialOf(std::string_view mass, std::string_view x, std::string_view y,
                       std::string_view z) {
  return "<inertial><mass value='" + std::string(mass) + "'/><inertia ixx='" + std::string(x) +
         "' ixy='0' ixz='0' iyy='" + std::string(y) + "' iyz='0' izz='" + std::string(z) +
         "'/></inertial>";
}

class UrdfCustomsTest : public testing::Test {
 protected:
  Loaded Load(const std::string& text, bool has_fixed_base = true) {
    Loaded loaded = LoadText(folder_, text, {has_fixed_base});
    EXPECT_EQ(loaded.mistake, "");
    return loaded;
  }

  ModelFolder folder_;
};

constexpr std::string_view kLimit = "<limit lower='-1' upper='1' effort='5' velocity='3'/>";
constexpr std::string_view kBody =
    "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
    "</inertial>";

TEST_F(UrdfCustomsTest, ALimitWithoutEffortAndVelocityLimitsNeither) {
  const Loaded loaded = Load(Arm(JointOf("revolute", "<limit lower='-1' upper='1'/>")));
  EXPECT_EQ(loaded.model.joints[0].limits.effort, kNoLimit);
  EXPECT_EQ(loaded.model.joints[0].limits.velocity, kNoLimit);
  EXPECT_EQ(loaded.model.joints[0].limits.upper, 1);
  EXPECT_THAT(
      loaded.warnings,
      ElementsAre(
          "robot.urdf:2: joint 'j' has a <limit> without effort, so that nothing limits that",
          "robot.urdf:2: joint 'j' has a <limit> without velocity, so that nothing limits "
          "that"));
}

TEST_F(UrdfCustomsTest, AnEffortThatIsNotPositiveIsNone) {
  const Loaded loaded =
      Load(Arm(JointOf("revolute", "<limit lower='-1' upper='1' effort='0' velocity='-1'/>")));
  EXPECT_EQ(loaded.model.joints[0].limits.effort, kNoLimit);
  EXPECT_EQ(loaded.model.joints[0].limits.velocity, kNoLimit);
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("effort=\"0\", which is taken for none"),
                                           HasSubstr("velocity=\"-1\", which is taken for none")));
}

TEST_F(UrdfCustomsTest, AJointWithoutARangeMovesFreely) {
  for (const std::string_view limit : {"", "<limit effort='5' velocity='3'/>",
                                       "<limit lower='1' upper='-1' effort='5' velocity='3'/>"}) {
    const Loaded loaded = Load(Arm(JointOf("revolute", limit)));
    EXPECT_EQ(loaded.model.joints[0].limits.lower, -kNoLimit) << limit;
    EXPECT_EQ(loaded.model.joints[0].limits.upper, kNoLimit) << limit;
    EXPECT_EQ(loaded.warnings.size(), 1u) << limit;
  }
}

TEST_F(UrdfCustomsTest, AJointThatCannotMoveIsFixedWhereItStands) {
  const std::string range = "<limit lower='0.5' upper='0.5' effort='5' velocity='3'/>";
  const Loaded turned = Load(Arm(JointOf("revolute", range)));
  const Joint& joint = turned.model.joints[0];
  EXPECT_EQ(joint.kind, JointKind::kFixed);
  EXPECT_NEAR(joint.origin.orientation_xyzw[1], std::sin(0.25), 1e-15);
  EXPECT_THAT(turned.warnings,
              ElementsAre(HasSubstr("joint 'j' cannot move, because both its limits are 0.5")));
  const Loaded moved = Load(Arm(JointOf("prismatic", range)));
  EXPECT_NEAR(moved.model.joints[0].origin.position_m[1], 0.5, 1e-15);
}

TEST_F(UrdfCustomsTest, AFollowerOfAFollowerFollowsTheFirstLeader) {
  const std::string leader = JointOf("continuous", "");
  const std::string text =
      Arm(leader, Tip("continuous", kBody, "<mimic joint='j' multiplier='2' offset='1'/>") +
                      "<link name='nail'>" + std::string(kBody) +
                      "</link><joint name='l' type='continuous'><parent link='tip'/><child "
                      "link='nail'/><mimic joint='k' multiplier='-3' offset='0.5'/></joint>");
  const Loaded loaded = Load(text);
  const Mimic& mimic = JointNamed(loaded.model, "l").mimic.value();
  EXPECT_EQ(mimic.joint, 0);
  EXPECT_EQ(mimic.multiplier, -6);
  EXPECT_EQ(mimic.offset, -2.5);
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST_F(UrdfCustomsTest, AMimicThatMeansNothingIsLeftOut) {
  const std::string leader = JointOf("continuous", "");
  const Loaded fixed = Load(Arm(leader, Tip("fixed", kBody, "<mimic joint='j'/>")));
  EXPECT_FALSE(JointNamed(fixed.model, "k").mimic.has_value());
  EXPECT_THAT(fixed.warnings, ElementsAre(HasSubstr("joint 'k' has not one coordinate to follow")));
  const Loaded nobody = Load(Arm(leader, Tip("continuous", kBody, "<mimic joint='jj'/>")));
  EXPECT_FALSE(JointNamed(nobody.model, "k").mimic.has_value());
  EXPECT_THAT(nobody.warnings,
              ElementsAre(HasSubstr("follows 'jj', but there is no such joint, so it moves by "
                                    "itself; did you mean 'j'?")));
}

TEST_F(UrdfCustomsTest, WhatFollowsAMistakeIsNoFurtherOne) {
  const std::string text = Arm(
      "<joint name='j' type='continuous'><parent link='base'/><child link='arm'/><mimic/></joint>",
      Tip("continuous", kBody, "<mimic joint='j'/>"));
  EXPECT_THAT(LoadText(folder_, text, {true}).mistakes,
              ElementsAre(HasSubstr("<mimic> in joint 'j' has no joint")));
  const std::string ring = Arm(JointOf("continuous", "<mimic joint='k'/>"),
                               Tip("continuous", kBody, "<mimic joint='j'/>"));
  EXPECT_THAT(LoadText(folder_, ring, {true}).mistakes,
              ElementsAre(HasSubstr("joint 'j' follows itself in the end"),
                          HasSubstr("joint 'k' follows itself in the end")));
}

TEST_F(UrdfCustomsTest, WhatFollowsAJointThatStandsIsFixed) {
  const Loaded loaded =
      Load(Arm(JointOf("fixed", ""), Tip("continuous", kBody, "<mimic joint='j' offset='0.3'/>")));
  EXPECT_EQ(JointNamed(loaded.model, "k").kind, JointKind::kFixed);
  EXPECT_NEAR(JointNamed(loaded.model, "k").origin.orientation_xyzw[0], std::sin(0.15), 1e-15);
}

// The leader goes from -1 to 1; a follower twice as far, the other way, and from -1 to 0.5.
TEST_F(UrdfCustomsTest, APairHasTheRangeThatBothAllow) {
  const Loaded loaded =
      Load(Arm(JointOf("revolute", kLimit),
               Tip("revolute", kBody,
                   "<mimic joint='j' multiplier='-2'/><limit lower='-1' upper='0.5' effort='1' "
                   "velocity='1'/>")));
  EXPECT_EQ(loaded.model.joints[0].limits.lower, -0.25);
  EXPECT_EQ(loaded.model.joints[0].limits.upper, 0.5);
  EXPECT_EQ(loaded.model.joints[1].limits.lower, -kNoLimit);
  EXPECT_THAT(loaded.warnings,
              ElementsAre(HasSubstr("joint 'k' follows joint 'j' with limits -1 and 0.5, so its "
                                    "leader may go from -0.25 to 0.5 only")));
}

TEST_F(UrdfCustomsTest, LimitsThatFightTheLeaderAreLeftOut) {
  const Loaded loaded =
      Load(Arm(JointOf("revolute", kLimit),
               Tip("revolute", kBody,
                   "<mimic joint='j'/><limit lower='2' upper='3' effort='1' velocity='1'/>")));
  EXPECT_EQ(loaded.model.joints[0].limits.upper, 1);
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("never takes it to; they are left out")));
}

TEST_F(UrdfCustomsTest, LinksThatNoJointNamesAreLeftOut) {
  const Loaded loaded =
      Load(Arm(JointOf("continuous", ""), "<link name='spare'/><link name='other'/>"));
  EXPECT_EQ(loaded.model.links.size(), 2u);
  EXPECT_THAT(
      loaded.warnings,
      ElementsAre("robot.urdf:3: link 'spare' is left out, because no joint joins it to the "
                  "robot (one of 2 such; `tcsim check -v` lists them)"));
  EXPECT_THAT(loaded.details, ElementsAre(HasSubstr("link 'spare'"), HasSubstr("link 'other'")));
}

TEST_F(UrdfCustomsTest, ARobotMayHaveNoName) {
  EXPECT_THAT(Load("<robot><link name='a'/></robot>").warnings,
              ElementsAre(HasSubstr("this <robot> has no name")));
  EXPECT_THAT(Load("<robot name=''><link name='a'/></robot>").warnings,
              ElementsAre(HasSubstr("this <robot> has no name")));
}

TEST_F(UrdfCustomsTest, ADocumentTypeWithoutEntitiesIsTaken) {
  EXPECT_THAT(Load("<!DOCTYPE robot><robot name='r'><link name='a'/></robot>").warnings, IsEmpty());
}

TEST_F(UrdfCustomsTest, ShapesWithoutExtentAreLeftOut) {
  const Loaded loaded = Load(
      "<robot name='r'><link name='a'><collision><geometry><sphere radius='0'/></geometry>"
      "</collision><collision name=''><origin xyz='0 0 1'/><geometry><box size='1 2 3'/></geometry>"
      "</collision><collision><geometry><box size='1 0 3'/></geometry></collision></link></robot>");
  ASSERT_EQ(loaded.model.links[0].shapes.size(), 1u);
  EXPECT_EQ(loaded.model.links[0].shapes[0].pose.position_m[2], 1);
  EXPECT_THAT(loaded.warnings,
              ElementsAre(HasSubstr("the sphere in link 'a' has a size of 0 and is left out of its "
                                    "collision shapes (one of 2 such")));
}

TEST_F(UrdfCustomsTest, CapsulesAreRead) {
  const Loaded loaded = Load(
      "<robot name='r'><link name='a'><collision><geometry><capsule radius='0.1' length='0.5'/>"
      "</geometry></collision><collision><geometry><capsule radius='0.1' length='0'/></geometry>"
      "</collision></link></robot>");
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const auto& capsule = std::get<CapsuleShape>(loaded.model.links[0].shapes.at(0).geometry);
  EXPECT_EQ(capsule.radius_m, 0.1);
  EXPECT_EQ(capsule.length_m, 0.5);
  EXPECT_EQ(std::get<SphereShape>(loaded.model.links[0].shapes.at(1).geometry).radius_m, 0.1);
}

TEST_F(UrdfCustomsTest, FrictionOfALinkIsTheFilesUnlessTheScenarioSaysAnother) {
  const std::string text =
      "<robot name='r'><link name='a'><contact><lateral_friction value='0.3'/></contact><collision>"
      "<geometry><sphere radius='1'/></geometry></collision></link><link name='b'><collision>"
      "<geometry><sphere radius='1'/></geometry></collision></link><link name='c'><collision>"
      "<geometry><sphere radius='1'/></geometry></collision></link>"
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
      "<joint name='k' type='fixed'><parent link='a'/><child link='c'/></joint>"
      "<gazebo reference='b'><mu1>0.05</mu1><mu2>0.05</mu2><material>Gazebo/Red</material></gazebo>"
      "</robot>";
  const Loaded loaded = Load(text);
  EXPECT_THAT(loaded.warnings, IsEmpty());
  EXPECT_EQ(LinkNamed(loaded.model, "a").shapes[0].friction, 0.3);
  EXPECT_EQ(LinkNamed(loaded.model, "b").shapes[0].friction, 0.05);
  EXPECT_EQ(LinkNamed(loaded.model, "c").shapes[0].friction, 0.8);
  const Loaded all = LoadText(folder_, text, {true, 0.6});
  for (const Link& link : all.model.links) EXPECT_EQ(link.shapes[0].friction, 0.6);
}

TEST_F(UrdfCustomsTest, AMeshThatIsOnlyDrawnMayBeMissing) {
  const Loaded loaded = Load(
      "<robot name='r'><link name='a'><visual><geometry><mesh filename='none.dae'/></geometry>"
      "</visual></link></robot>");
  EXPECT_THAT(
      loaded.warnings,
      ElementsAre("robot.urdf:1: link 'a' is drawn without a mesh: none.dae does not exist"));
}

TEST_F(UrdfCustomsTest, OfTwoElementsTheFirstIsTaken) {
  const Loaded loaded = Load(Arm(JointOf("continuous", "<axis xyz='1 0 0'/>")));
  EXPECT_EQ(loaded.model.joints[0].axis[1], 1);
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("joint 'j' has a second <axis>, which is left "
                                                     "out; the first is on line 2")));
}

TEST_F(UrdfCustomsTest, WhatIsFixedToALinkOnlyAddsToIt) {
  // A point of mass, and a part with an inertia that no body has, on an arm that has plenty.
  for (const std::string& part :
       {InertialOf("0.001", "0", "0", "0"), InertialOf("0.01", "1e-6", "1e-6", "1e-5")}) {
    const Loaded loaded = Load(Arm(JointOf("continuous", ""), Tip("fixed", part)));
    EXPECT_THAT(loaded.warnings, IsEmpty()) << part;
    const TreeBody body = MakeTree(loaded.model).bodies.at(0);
    EXPECT_NEAR(body.mass_kg, part.find("0.001") == std::string::npos ? 1.01 : 1.001, 1e-12);
  }
}

TEST_F(UrdfCustomsTest, AnImpossibleInertiaBecomesTheNearest) {
  const Loaded loaded = Load(Arm(JointOf("continuous", ""),
                                 Tip("continuous", InertialOf("0.024", "9e-7", "3e-6", "2e-6")) +
                                     "<link name='t2'>" + InertialOf("1", "1", "1", "4") +
                                     "</link><joint name='m' type='continuous'><parent link='arm'/>"
                                     "<child link='t2'/></joint>"));
  EXPECT_THAT(
      loaded.warnings,
      ElementsAre(HasSubstr("link 't2' has the moments of inertia (1, 1, 4) kg m^2, one of "
                            "which exceeds the sum of the two others, which no body has: the "
                            "nearest are taken, (1.67, 1.67, 3.33) kg m^2 (the worst of 2")));
  EXPECT_EQ(loaded.details.size(), 2u);
  const Inertial& tip = LinkNamed(loaded.model, "tip").inertial.value();
  EXPECT_NEAR(tip.ixx_kgm2, 9e-7 + 1e-7 / 3, 1e-13);
  EXPECT_NEAR(tip.iyy_kgm2, 3e-6 - 1e-7 / 3, 1e-13);
  EXPECT_NEAR(tip.izz_kgm2, 2e-6 + 1e-7 / 3, 1e-13);
}

TEST_F(UrdfCustomsTest, WhatRoundingBrokeIsMendedWithoutAWord) {
  const Loaded loaded = Load(
      Arm(JointOf("continuous", ""), Tip("continuous", InertialOf("1", "1", "2", "3.000001"))));
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const auto moments = PrincipalMoments(LinkNamed(loaded.model, "tip").inertial.value());
  EXPECT_LE(moments[2], moments[0] + moments[1]);
  EXPECT_NEAR(moments[2], 3.000001, 1e-6);
}

TEST_F(UrdfCustomsTest, WhatMovesWithoutMassGetsTheLeast) {
  const Loaded none = Load(Arm(JointOf("continuous", ""), Tip("continuous", "")));
  EXPECT_THAT(none.warnings,
              ElementsAre(HasSubstr("link 'tip' moves (joint 'k' moves it) but has no "
                                    "mass: 0.001 kg and 4e-07 kg m^2 are taken")));
  const Loaded point =
      Load(Arm(JointOf("continuous", ""), Tip("continuous", InertialOf("0.5", "0", "0", "0"))));
  EXPECT_THAT(
      point.warnings,
      ElementsAre(HasSubstr("link 'tip' moves (joint 'k' moves it) but has the moments of "
                            "inertia (0, 0, 0) kg m^2: (0.000122, 0.000122, 0.000122) kg m^2 are "
                            "taken")));
  const Loaded no_mass =
      Load(Arm(JointOf("continuous", ""), Tip("continuous", InertialOf("0", "1", "1", "1"))));
  EXPECT_THAT(no_mass.warnings,
              ElementsAre(HasSubstr("has an inertia but a mass of 0"), HasSubstr("has no mass")));
}

TEST(NearestMoments, AreThoseOfTheNearestBody) {
  using Moments = std::array<double, 3>;
  EXPECT_EQ(NearestMoments({1, 2, 3}), (Moments{1, 2, 3}));
  const auto expect_near = [](const Moments& had, const Moments& want) {
    const Moments got = NearestMoments(had);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], 1e-12) << i;
  };
  expect_near({0, 0, 3}, {1, 1, 2});
  expect_near({-5, 0, 1}, {0, 0.5, 0.5});
  expect_near({-3, -2, -1}, {0, 0, 0});
}

}  // namespace
}  // namespace tcs
