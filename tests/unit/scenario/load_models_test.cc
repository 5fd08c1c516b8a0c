// `models` of a scenario: robots from files, bodies of one shape, and what is wrong with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::string_view kArm = R"(<robot name="two_joints">
  <link name="base"/>
  <link name="upper"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="fore"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="tip"/>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/>
    <limit lower="0.5" upper="2" effort="1" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="fore"/><child link="tip"/></joint>
  <gazebo/>
</robot>
)";

constexpr std::string_view kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

// Its lines are counted on.
constexpr std::string_view kGoodModels = R"(duration: 1s
dynamics: {gravity: [0, 0, -9.81]}
models:
  arm:
    urdf: arm.urdf
    at: {position: [1, 2, 3], orientation: [0, 0, 1, 0]}
    fixed_base: true
    joints: {elbow: 1.5}
    friction: 0.5
  floor: {plane: [0, 0, 1], position: [0, 0, -1], friction: 0.9}
  wall: {box: [1, 2, 3], static: true, orientation: [1, 0, 0, 0]}
  crate: {box: [1, 2, 3], mass: 12, position: [0, 0, 5], linear_velocity: [1, 0, 0]}
  ball: {sphere: 0.5, mass: 2, angular_velocity: [0, 0, 9]}
  can: {cylinder: {radius: 1, length: 2}, mass: 12}
  pill: {capsule: {radius: 1, length: 2}, mass: 10}
  rock: {mesh: rock.obj, scale: [1, 2, 3], mass: 6}
robots:
  r: {clients: {c: {command: [./controller]}}}
)";

struct Folder : ScenarioFolder {
  Folder() {
    Write("arm.urdf", kArm);
    Write("rock.obj", kTetrahedron);
  }
};

Scenario Loaded(const Folder& folder, std::string_view text = kGoodModels) {
  return ScenarioOf(LoadScenario(folder.Write("s.yaml", text)));
}

const RobotModel& Named(const Scenario& scenario, std::string_view name) {
  for (const RobotModel& model : scenario.world->models) {
    if (model.name == name) return model;
  }
  throw std::logic_error("no model " + std::string(name));
}

TEST(LoadModels, ThoseThatStandTogetherAreOneIsland) {
  const Folder folder;
  EXPECT_TRUE(Loaded(folder).world->models_together.empty());
  std::string text(kGoodModels);
  const std::string_view gravity = "gravity: [0, 0, -9.81]";
  text.replace(text.find(gravity), gravity.size(), "together: [[ball, crate]]");
  const WorldSpec world = *Loaded(folder, text).world;
  ASSERT_EQ(world.models_together.size(), 1u);
  ASSERT_EQ(world.models_together[0].size(), 2u);
  EXPECT_EQ(world.models[static_cast<std::size_t>(world.models_together[0][0])].name, "ball");
  EXPECT_EQ(world.models[static_cast<std::size_t>(world.models_together[0][1])].name, "crate");
  EXPECT_TRUE(world.together.empty());
}

TEST(LoadModels, ABodyAndAModelDoNotStandTogether) {
  const Folder folder;
  std::string text(kGoodModels);
  const std::string_view gravity = "gravity: [0, 0, -9.81]";
  text.replace(text.find(gravity), gravity.size(), "together: [[ship, crate]]");
  text += "bodies: {ship: {mass: 1, inertia: [1, 1, 1]}}\n";
  const auto loaded = LoadScenario(folder.Write("s.yaml", text));
  ASSERT_TRUE(std::holds_alternative<LoadError>(loaded));
  EXPECT_THAT(std::get<LoadError>(loaded).message,
              testing::HasSubstr("names 'crate' beside 'ship', but one of them is a body"));
}

TEST(LoadModels, ARobotStandsWhereTheScenarioSays) {
  const Folder folder;
  const Scenario scenario = Loaded(folder);
  const RobotModel& arm = Named(scenario, "arm");
  EXPECT_TRUE(arm.has_fixed_base);
  EXPECT_EQ(arm.at, (Pose{{1, 2, 3}, {0, 0, 1, 0}}));
  EXPECT_THAT(arm.joints.at(1).initial_position, ElementsAre(1.5));
  EXPECT_TRUE(arm.joints.at(0).initial_position.empty());
  EXPECT_EQ(arm.links.at(1).shapes.at(0).friction, 0.5);
  EXPECT_FALSE(arm.has_self_collision);
  EXPECT_THAT(scenario.warnings, ElementsAre(folder.Path("arm.urdf") +
                                             ":11: <gazebo> is not understood and left out"));
}

TEST(LoadModels, AJointMayMoveAtTheStart) {
  const Folder folder;
  const Scenario scenario =
      Loaded(folder, WithReplaced("{elbow: 1.5}", "{elbow: [1.5, -2], shoulder: 3}", kGoodModels));
  const RobotModel& arm = Named(scenario, "arm");
  EXPECT_THAT(arm.joints.at(1).initial_position, ElementsAre(1.5));
  EXPECT_THAT(arm.joints.at(1).initial_velocity, ElementsAre(-2));
  EXPECT_THAT(arm.joints.at(0).initial_position, ElementsAre(3));
  EXPECT_TRUE(arm.joints.at(0).initial_velocity.empty());
}

TEST(LoadModels, AJointThatMayNotStartAt0StartsAsNearAsItMay) {
  const Folder folder;
  const Scenario scenario =
      Loaded(folder, WithReplaced("    joints: {elbow: 1.5}\n", "", kGoodModels));
  EXPECT_THAT(Named(scenario, "arm").joints.at(1).initial_position, ElementsAre(0.5));
  EXPECT_THAT(
      scenario.warnings,
      testing::Contains(folder.Path("s.yaml") +
                        ":4: models.arm: 0 is beyond the limits of some joints, which start "
                        "as near to it as they may; to start them there or elsewhere, write "
                        "joints: {elbow: 0.5}"));
}

TEST(LoadModels, ABaseWithoutMassIsFixed) {
  const Folder folder;
  const Scenario scenario =
      Loaded(folder, WithReplaced("fixed_base: true", "fixed_base: false", kGoodModels));
  EXPECT_TRUE(Named(scenario, "arm").has_fixed_base);
  EXPECT_THAT(scenario.warnings, testing::Contains(HasSubstr("link 'base' is the root")));
}

// The pair of a chain a - b - c - d that starts folded: d is in a, and c and a are joined to
// others.
constexpr std::string_view kFolded = R"(<robot name="folded">
  <link name="a"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="b"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="c"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="d"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><capsule radius="0.05" length="0.1"/></geometry></collision></link>
  <joint name="i" type="continuous"><parent link="a"/><child link="b"/></joint>
  <joint name="j" type="continuous"><parent link="b"/><child link="c"/></joint>
  <joint name="k" type="prismatic"><parent link="c"/><child link="d"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>)";

constexpr std::string_view kFoldedScenario = R"(duration: 1s
dynamics: {}
models:
  arm: {urdf: folded.urdf, fixed_base: true, self_collision: true}
robots:
  r: {clients: {c: {command: [sleep, "1"]}}}
)";

TEST(LoadModels, LinksThatOverlapAtTheStartAreIgnored) {
  const Folder folder;
  folder.Write("folded.urdf", kFolded);
  const Scenario scenario = Loaded(folder, kFoldedScenario);
  EXPECT_THAT(Named(scenario, "arm").ignored_pairs, ElementsAre(std::pair(0, 3)));
  EXPECT_THAT(scenario.warnings,
              ElementsAre(HasSubstr(":4: models.arm: links overlap at the start, and such do not "
                                    "collide; to say so, write collisions: {ignore: [[a, d]]}")));
  // What is said is not said again; what does not collide needs no word.
  for (const std::string_view way :
       {"self_collision: true, collisions: {ignore: [[d, a]]}", "self_collision: false"}) {
    EXPECT_THAT(Loaded(folder, WithReplaced("self_collision: true", way, kFoldedScenario)).warnings,
                testing::IsEmpty());
  }
  // Where they are apart there is nothing to ignore, and touching is no overlap: d is 0.15 above.
  const Scenario apart = Loaded(
      folder, WithReplaced("self_collision", "joints: {k: 0.15}, self_collision", kFoldedScenario));
  EXPECT_THAT(Named(apart, "arm").ignored_pairs, testing::IsEmpty());
}

TEST(LoadModels, MoveItSaysWhichLinksAreIgnored) {
  const Folder folder;
  folder.Write("folded.urdf", kFolded);
  folder.Write("arm.srdf",
               "<robot name='folded'><disable_collisions link1='b' link2='d' reason='Never'/>"
               "<disable_collisions link1='d' link2='a'/><disable_collisions link1='x' link2='a'/>"
               "</robot>");
  const Scenario scenario = Loaded(
      folder, WithReplaced("self_collision: true",
                           "self_collision: true, collisions: {srdf: arm.srdf}", kFoldedScenario));
  EXPECT_THAT(Named(scenario, "arm").ignored_pairs, ElementsAre(std::pair(1, 3), std::pair(0, 3)));
  EXPECT_THAT(scenario.warnings, testing::IsEmpty());
}

TEST(LoadModels, WhatIsIgnoredIsChecked) {
  const Folder folder;
  folder.Write("folded.urdf", kFolded);
  const auto complaint = [&](std::string_view way) {
    return Complaint(folder, WithReplaced("self_collision: true", way, kFoldedScenario));
  };
  EXPECT_THAT(complaint("collisions: {ignore: [[a, d]]}"), HasSubstr("add self_collision: true"));
  EXPECT_THAT(complaint("self_collision: true, collisions: {ignore: [[a, dd]]}"),
              HasSubstr("names the unknown link 'dd' of arm; did you mean 'd'?"));
  EXPECT_THAT(complaint("self_collision: true, collisions: {ignore: [[a]]}"),
              HasSubstr("write [LINK, LINK]"));
  EXPECT_THAT(complaint("self_collision: true, collisions: {srdf: folded.yaml}"),
              HasSubstr("No such file"));
}

TEST(LoadModels, CheckSaysAllMistakesOfARobotsFile) {
  const Folder folder;
  std::string arm(kArm);
  for (std::size_t at; (at = arm.find("value=\"1\"")) != std::string::npos;) {
    arm.replace(at, 9, "value=\"x\"");
  }
  folder.Write("arm.urdf", arm);
  const auto checked = CheckScenario(folder.Write("s.yaml", kGoodModels), {});
  const auto& errors = std::get<std::vector<LoadError>>(checked);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_THAT(errors[0].message, StartsWith(folder.Path("arm.urdf") + ":3: value of <mass>"));
  EXPECT_THAT(errors[1].message, StartsWith(folder.Path("arm.urdf") + ":5: value of <mass>"));
}

TEST(LoadModels, WhatStandsIsOfTheWorld) {
  const Folder folder;
  const Scenario scenario = Loaded(folder);
  const std::vector<Shape>& fixtures = scenario.world->fixtures;
  ASSERT_EQ(fixtures.size(), 2u);
  EXPECT_EQ(fixtures[0].name, "floor");
  EXPECT_TRUE(std::holds_alternative<PlaneShape>(fixtures[0].geometry));
  EXPECT_EQ(fixtures[0].pose, (Pose{{0, 0, -1}, {0, 0, 0, 1}}));
  EXPECT_EQ(fixtures[0].friction, 0.9);
  EXPECT_EQ(fixtures[1].name, "wall");
  EXPECT_EQ(std::get<BoxShape>(fixtures[1].geometry).size_m, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(fixtures[1].pose.orientation_xyzw, (std::array<double, 4>{1, 0, 0, 0}));
}

TEST(LoadModels, ANormalIsTheWayUpFromAPlane) {
  const Folder folder;
  struct Case {
    std::string_view written;
    std::array<double, 3> normal;
  };
  for (const Case& each : {Case{"[2, 0, 0]", {1, 0, 0}}, Case{"[0, -3, 0]", {0, -1, 0}},
                           Case{"[0, 0, -1]", {0, 0, -1}}, Case{"[3, 0, 4]", {0.6, 0, 0.8}}}) {
    const Scenario scenario = Loaded(
        folder,
        WithReplaced("plane: [0, 0, 1]", "plane: " + std::string(each.written), kGoodModels));
    const auto up = Rotate(scenario.world->fixtures[0].pose.orientation_xyzw, {0, 0, 1});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(up[i], each.normal[i], 1e-12) << each.written;
  }
}

TEST(LoadModels, ABodyOfOneShapeHasItsMassSpreadEvenly) {
  const Folder folder;
  const Scenario scenario = Loaded(folder);
  const auto moments = [&](std::string_view name) {
    const Inertial& inertial = Named(scenario, name).links.at(0).inertial.value();
    return std::array<double, 3>{inertial.ixx_kgm2, inertial.iyy_kgm2, inertial.izz_kgm2};
  };
  EXPECT_EQ(moments("crate"), (std::array<double, 3>{13, 10, 5}));
  EXPECT_EQ(moments("ball"), (std::array<double, 3>{0.2, 0.2, 0.2}));
  EXPECT_EQ(moments("can"), (std::array<double, 3>{7, 7, 6}));
  // A cylinder of 6 kg and two half balls of 2 kg, each 1.375 m from the middle.
  const double half_ball = 2 * (2.0 / 5 - 9.0 / 64) + 2 * 1.375 * 1.375;
  EXPECT_NEAR(moments("pill")[0], 6 * 7 / 12.0 + 2 * half_ball, 1e-12);
  EXPECT_NEAR(moments("pill")[2], 3 + 1.6, 1e-12);
  const RobotModel& crate = Named(scenario, "crate");
  EXPECT_FALSE(crate.has_fixed_base);
  EXPECT_EQ(crate.at.position_m, (std::array<double, 3>{0, 0, 5}));
  EXPECT_EQ(crate.linear_velocity_mps, (std::array<double, 3>{1, 0, 0}));
  EXPECT_EQ(Named(scenario, "ball").angular_velocity_radps, (std::array<double, 3>{0, 0, 9}));
}

// With legs a, b and c along x, y and z a corner's tetrahedron has its middle a quarter of each
// away.
TEST(LoadModels, AMeshHasTheInertiaOfItsVolume) {
  const Folder folder;
  const Scenario scenario = Loaded(folder);
  const Inertial& rock = Named(scenario, "rock").links.at(0).inertial.value();
  EXPECT_NEAR(rock.frame.position_m[0], 0.25, 1e-12);
  EXPECT_NEAR(rock.frame.position_m[2], 0.75, 1e-12);
  const double m = 6, a = 1, b = 2, c = 3;
  EXPECT_NEAR(rock.ixx_kgm2, 3 * m * (b * b + c * c) / 80, 1e-12);
  EXPECT_NEAR(rock.izz_kgm2, 3 * m * (a * a + b * b) / 80, 1e-12);
  EXPECT_NEAR(rock.ixy_kgm2, m * a * b / 80, 1e-12);
  EXPECT_NEAR(rock.iyz_kgm2, m * b * c / 80, 1e-12);
}

TEST(LoadModels, AJointWithSeveralCoordinatesStartsWithAsMany) {
  const Folder folder;
  folder.Write("arm.urdf", WithReplaced("type=\"continuous\"", "type=\"planar\"", kArm));
  const Scenario scenario =
      Loaded(folder, WithReplaced("{elbow: 1.5}", "{elbow: 1, shoulder: [1, 2, 3]}", kGoodModels));
  EXPECT_THAT(Named(scenario, "arm").joints.at(0).initial_position, ElementsAre(1, 2, 3));
}

TEST(LoadModels, PackagesAreLookedForWhereTheScenarioSays) {
  const Folder folder;
  std::filesystem::create_directories(folder.Path("share/rocks"));
  folder.Write("share/rocks/stone.obj", kTetrahedron);
  folder.Write("arm.urdf", WithReplaced("<sphere radius=\"0.1\"/>",
                                        "<mesh filename=\"package://rocks/stone.obj\"/>", kArm));
  EXPECT_THAT(Complaint(folder, kGoodModels), HasSubstr("is in the package 'rocks'"));
  const Scenario scenario = Loaded(
      folder,
      WithReplaced("    friction: 0.5", "    packages: [\"${scenario_dir}/share\"]", kGoodModels));
  EXPECT_TRUE(
      std::holds_alternative<MeshShape>(Named(scenario, "arm").links.at(1).shapes.at(0).geometry));
}

struct WrongModel {
  std::string_view name;
  std::string_view from;  // in kGoodModels
  std::string_view to;
  std::string_view place;
  std::vector<std::string_view> words;
};

void PrintTo(const WrongModel& mistake, std::ostream* out) { *out << mistake.name; }

class ModelMistakeTest : public testing::TestWithParam<WrongModel> {};

TEST_P(ModelMistakeTest, IsOneSentenceWithItsPlace) {
  const Folder folder;
  const WrongModel& mistake = GetParam();
  const std::string path =
      folder.Write("s.yaml", WithReplaced(mistake.from, mistake.to, kGoodModels));
  const std::string complaint = Complaint(folder, LoadScenario(path));
  EXPECT_THAT(complaint, StartsWith(std::string(mistake.place) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(complaint, HasSubstr(std::string(words)));
  }
}

const WrongModel kWrongModels[] = {
    {"NoDynamics",
     "dynamics: {gravity: [0, 0, -9.81]}\n",
     "",
     "s.yaml:2",
     {"models need physics", "dynamics: {}"}},
    {"EngineWithoutJoints",
     "{gravity: [0, 0, -9.81]}",
     "{engine: ode}",
     "s.yaml:3",
     {"models need an engine that knows joints", "ode", "simbody"}},
    {"IntegratorWithoutJoints",
     "{gravity: [0, 0, -9.81]}",
     "{integrator: verlet}",
     "s.yaml:3",
     {"models move by the integrator runge_kutta3 only", "leave dynamics.integrator out"}},
    {"SaysNotWhatItIs",
     "sphere: 0.5, ",
     "",
     "s.yaml:13",
     {"models.ball does not say what it is", "urdf"}},
    {"Misspelt", "sphere: 0.5", "spere: 0.5", "s.yaml:13", {"'spere'", "did you mean 'sphere'?"}},
    {"TwoShapes", "sphere: 0.5,", "sphere: 0.5, box: [1, 1, 1],", "s.yaml:13", {"beside"}},
    {"UnknownKey", "fixed_base", "fixed_bass", "s.yaml:7", {"'fixed_bass'", "'fixed_base'?"}},
    {"KeyOfARobotOnABall",
     "sphere: 0.5,",
     "sphere: 0.5, fixed_base: true,",
     "s.yaml:13",
     {"unknown key"}},
    {"BadName", "  ball:", "  \"a/b\":", "s.yaml:13", {"'a/b' is not a name"}},
    {"NameOfABody",
     "models:",
     "bodies: {ball: {mass: 1, inertia: [1, 1, 1]}}\nmodels:",
     "s.yaml:14",
     {"models.ball has the same name as a body"}},
    {"TogetherWithAStranger",
     "gravity: [0, 0, -9.81]",
     "together: [[ball, cam]]",
     "s.yaml:2",
     {"dynamics.together[0][1] names the unknown model 'cam'", "'can'?"}},
    {"TogetherTwice",
     "gravity: [0, 0, -9.81]",
     "together: [[ball, can], [can, pill]]",
     "s.yaml:2",
     {"together[1][0] names the model 'can' a second time", "one list"}},
    {"TogetherAlone",
     "gravity: [0, 0, -9.81]",
     "together: [[can]]",
     "s.yaml:2",
     {"dynamics.together[0] names one model", "two or more"}},
    {"NoSuchFile",
     "urdf: arm.urdf",
     "urdf: leg.urdf",
     "s.yaml:5",
     {"models.arm.urdf: ", "leg.urdf: cannot be read: No such file"}},
    {"NoSuchFileAndNoText",
     "urdf: arm.urdf",
     "urdf: leg\xbb.urdf",
     "s.yaml:5",
     {"models.arm.urdf: ", "leg\\xbb.urdf: cannot be read: No such file"}},
    {"NoPath", "urdf: arm.urdf", "urdf: \"\"", "s.yaml:5", {"is empty"}},
    {"UnknownJoint",
     "{elbow: 1.5}",
     "{elbw: 1.5}",
     "s.yaml:8",
     {"joint 'elbw' of arm", "did you mean 'elbow'?"}},
    {"FixedJoint",
     "{elbow: 1.5}",
     "{elbow: 1, flange: 0}",
     "s.yaml:8",
     {"joints.flange is for a fixed joint"}},
    {"StartBeyondLimits",
     "{elbow: 1.5}",
     "{elbow: 3}",
     "s.yaml:8",
     {"joints.elbow", "beyond its limits"}},
    {"StartIsAListOfOne",
     "{elbow: 1.5}",
     "{elbow: [1]}",
     "s.yaml:8",
     {"joints.elbow has 1 numbers; write 2, like [0.5, 0] (position, velocity)"}},
    {"StartMovesAtNoNumber",
     "{elbow: 1.5}",
     "{elbow: [1, fast]}",
     "s.yaml:8",
     {"joints.elbow", "'fast'"}},
    {"AtIsAList",
     "{position: [1, 2, 3], orientation: [0, 0, 1, 0]}",
     "[1, 2, 3]",
     "s.yaml:6",
     {"not a map"}},
    {"NoUnitQuaternion", "[0, 0, 1, 0]}", "[0, 0, 1, 1]}", "s.yaml:6", {"not a unit quaternion"}},
    {"VelocityOfAFixedBase",
     "    friction: 0.5",
     "    linear_velocity: [1, 0, 0]",
     "s.yaml:9",
     {"base that does not move"}},
    {"NegativeFriction", "friction: 0.5", "friction: -1", "s.yaml:9", {"must not be negative"}},
    {"PackagesAreNoFolder",
     "    friction: 0.5",
     "    packages: [none]",
     "s.yaml:9",
     {"'none'", "no folder"}},
    {"NoMass", "sphere: 0.5, mass: 2", "sphere: 0.5", "s.yaml:13", {"neither mass nor static"}},
    {"ZeroMass", "sphere: 0.5, mass: 2", "sphere: 0.5, mass: 0", "s.yaml:13", {"must be positive"}},
    {"MassAndStatic", "sphere: 0.5,", "sphere: 0.5, static: true,", "s.yaml:13", {"does not move"}},
    {"VelocityOfWhatStands",
     "static: true",
     "static: true, angular_velocity: [1, 0, 0]",
     "s.yaml:11",
     {"does not move"}},
    {"MassOfAPlane", "friction: 0.9", "mass: 1", "s.yaml:10", {"a plane, which cannot move"}},
    {"PlaneThatIsNotStatic", "friction: 0.9", "static: false", "s.yaml:10", {"cannot move"}},
    {"PlaneWithoutANormal",
     "[0, 0, 1], position",
     "[0, 0, 0], position",
     "s.yaml:10",
     {"no direction"}},
    {"OrientationOfAPlane", "friction: 0.9", "orientation: [0, 0, 0, 1]", "s.yaml:10", {"normal"}},
    {"FlatBox",
     "box: [1, 2, 3], mass",
     "box: [1, 2, 0], mass",
     "s.yaml:12",
     {"edge that is not positive"}},
    {"NegativeRadius", "sphere: 0.5", "sphere: -0.5", "s.yaml:13", {"radius in metres"}},
    {"NoLength",
     "{radius: 1, length: 2}, mass: 12",
     "{radius: 1}, mass: 12",
     "s.yaml:14",
     {"lacks the key 'length'"}},
    {"FlatScale", "[1, 2, 3], mass: 6", "[1, 0, 3], mass: 6", "s.yaml:16", {"0 along an axis"}},
    {"ScaleOfABall", "sphere: 0.5", "sphere: 0.5, scale: 2", "s.yaml:13", {"unknown key 'scale'"}},
    {"NoSuchMesh", "rock.obj", "rick.obj", "s.yaml:16", {"models.rock.mesh: ", "No such file"}},
    {"MeshOfAnotherKind", "rock.obj", "arm.urdf", "s.yaml:16", {".stl, .obj, .dae or .glb"}},
};

std::string NameOfWrongModel(const testing::TestParamInfo<WrongModel>& info) {
  return std::string(info.param.name);
}
INSTANTIATE_TEST_SUITE_P(All, ModelMistakeTest, testing::ValuesIn(kWrongModels), NameOfWrongModel);

TEST(LoadModels, SomethingMoves) {
  const Folder folder;
  EXPECT_THAT(Complaint(folder,
                        "duration: 1s\ndynamics: {}\nmodels: {floor: {plane: [0, 0, 1]}}\n"
                        "robots: {r: {clients: {c: {command: [./controller]}}}}\n"),
              "s.yaml:3: models has nothing that moves; give one of them mass, or remove dynamics");
  EXPECT_THAT(Complaint(folder,
                        "duration: 1s\ndynamics: {}\nmodels: {}\n"
                        "robots: {r: {clients: {c: {command: [./controller]}}}}\n"),
              "s.yaml:3: models is empty; describe at least one model");
}

// Its lines are counted on.
constexpr std::string_view kFlying = R"(duration: 1s
dynamics: {}
models:
  other: {urdf: arm.urdf, fixed_base: true, joints: {elbow: 1}, rotors: {shoulder: {thrust: 1}}}
  arm:
    urdf: arm.urdf
    joints: {elbow: 1}
    fixed_base: true
    rotors:
      left: {link: base, at: {position: [0, 1, 0], orientation: [1, 0, 0, 0]}, thrust: 2e-5, drag: 3e-7, direction: cw, time_constant: 20ms, limit: 900}
      shoulder: {thrust: 1e-5}
robots:
  r: {clients: {c: {command: [./controller]}}}
channels:
  motors: {type: udp_json, commands: {model: arm, rotors: [shoulder, left], listen: "127.0.0.1:47011", latency: 2ms}}
  shares: {type: dds, commands: {model: arm, rotors: [left], drive: normalised, message: std_msgs/msg/Float64MultiArray, topic: /m}}
  push: {type: udp_json, commands: {on: arm/fore, axes: link, limits: {force: 5}, listen: "127.0.0.1:47012"}}
  servo: {type: udp_json, commands: {model: arm, joints: [elbow], lag: 30ms, listen: "127.0.0.1:47013"}}
  other: {type: udp_json, commands: {model: arm, joints: [shoulder], listen: "127.0.0.1:47014"}}
)";

TEST(LoadRotors, AreOnLinksAndChannelsSpinThem) {
  const Folder folder;
  const Scenario scenario = Loaded(folder, kFlying);
  const RobotModel& arm = Named(scenario, "arm");
  ASSERT_EQ(arm.rotors.size(), 2u);
  const Rotor& left = arm.rotors[0];
  EXPECT_EQ(left.link, 0);
  EXPECT_EQ(left.frame, (Pose{{0, 1, 0}, {1, 0, 0, 0}}));
  EXPECT_EQ(left.thrust_ns2, 2e-5);
  EXPECT_EQ(left.drag_nms2, 3e-7);
  EXPECT_TRUE(left.is_clockwise);
  EXPECT_EQ(left.time_constant, VirtualDuration::Milliseconds(20));
  EXPECT_EQ(left.most_radps, 900);
  // Called as a joint it is on its parent, along its axis, which is x.
  const Rotor& shoulder = arm.rotors[1];
  EXPECT_EQ(shoulder.link, 0);
  const auto along = Rotate(shoulder.frame.orientation_xyzw, {0, 0, 1});
  EXPECT_NEAR(along[0], 1, 1e-12);
  const RotorDriveSpec& motors = scenario.commands[0].rotors.value();
  EXPECT_EQ(motors.model, "arm");
  EXPECT_THAT(motors.rotors, ElementsAre(2, 1));  // after the one of the other model
  EXPECT_THAT(motors.names, ElementsAre("shoulder", "left"));
  EXPECT_THAT(motors.most_radps, ElementsAre(kNoLimit, 900));
  EXPECT_FALSE(motors.is_normalised);
  EXPECT_EQ(scenario.commands[0].latency, VirtualDuration::Milliseconds(2));
  EXPECT_TRUE(scenario.commands[1].rotors.value().is_normalised);
  const CommandChannelSpec& push = scenario.commands[2];
  EXPECT_EQ(push.link.value().name, "arm/fore");
  EXPECT_EQ(push.link.value().link, 4 + 2);
  EXPECT_TRUE(push.in_body_frame);
  EXPECT_THAT(push.most_force_n, ElementsAre(5, 5, 5));
  EXPECT_EQ(arm.joints[1].drive_lag, VirtualDuration::Milliseconds(30));
  EXPECT_EQ(arm.joints[0].drive_lag, VirtualDuration{});
  EXPECT_EQ(scenario.commands[3].joints.value().limits[0].upper, 2);
}

class RotorMistakeTest : public testing::TestWithParam<WrongModel> {};

TEST_P(RotorMistakeTest, IsOneSentenceWithItsPlace) {
  const Folder folder;
  const WrongModel& mistake = GetParam();
  const std::string path =
      folder.Write("s.yaml", WithReplaced(mistake.from, mistake.to, std::string(kFlying)));
  const std::string complaint = Complaint(folder, LoadScenario(path));
  EXPECT_THAT(complaint, StartsWith(std::string(mistake.place) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(complaint, HasSubstr(std::string(words)));
  }
}

const WrongModel kRotorMistakes[] = {
    {"UnknownKey", "thrust: 2e-5", "trust: 2e-5", "s.yaml:10", {"'trust'", "'thrust'?"}},
    {"NoThrust",
     "      shoulder: {thrust: 1e-5}",
     "      shoulder: {}",
     "s.yaml:11",
     {"lacks the key 'thrust'"}},
    {"UnknownLink",
     "{link: base,",
     "{link: bass,",
     "s.yaml:10",
     {"unknown link 'bass' of arm", "'base'?"}},
    {"Nowhere",
     "      shoulder: {thrust: 1e-5}",
     "      tail: {thrust: 1e-5}",
     "s.yaml:11",
     {"does not say where it is; add link: base"}},
    {"AtOfNoLink", "{link: base, at", "{at", "s.yaml:10", {"add link"}},
    {"DragWithoutDirection", " direction: cw,", "", "s.yaml:10", {"lacks the key 'direction'"}},
    {"UnknownDirection", "direction: cw", "direction: wc", "s.yaml:10", {"unknown 'wc'", "cw"}},
    {"NegativeThrust", "thrust: 2e-5", "thrust: -2e-5", "s.yaml:10", {"must not be negative"}},
    {"NoLimit", "limit: 900", "limit: 0", "s.yaml:10", {"must be positive"}},
    {"UnknownRotor",
     "[shoulder, left]",
     "[shoulder, lefd]",
     "s.yaml:15",
     {"unknown rotor 'lefd' of arm", "'left'?"}},
    {"RotorTwice", "[shoulder, left]", "[left, left]", "s.yaml:15", {"a second time"}},
    {"ShareOfNothing",
     "rotors: [left], drive",
     "rotors: [shoulder], drive",
     "s.yaml:16",
     {"'shoulder' has no limit"}},
    {"UnknownQuantity",
     "drive: normalised",
     "drive: normal",
     "s.yaml:16",
     {"speed and normalised"}},
    {"RotorsAndJoints",
     "rotors: [left], drive",
     "rotors: [left], joints: [elbow], drive",
     "s.yaml:16",
     {"beside rotors"}},
    {"WrenchOnRotors",
     "std_msgs/msg/Float64MultiArray",
     "geometry_msgs/msg/Wrench",
     "s.yaml:16",
     {"rotors are driven by"}},
    {"AxesOfABody", "axes: link", "axes: body", "s.yaml:17", {"unknown 'body'", "link"}},
    {"UnknownPushedLink",
     "on: arm/fore",
     "on: arm/four",
     "s.yaml:17",
     {"unknown link 'four' of arm"}},
    {"LagOfALink", "axes: link", "lag: 1ms", "s.yaml:17", {"unknown key 'lag'"}},
    {"TwoLags",
     "joints: [shoulder], listen",
     "joints: [elbow], listen",
     "s.yaml:19",
     {"'elbow' with another lag than channel servo"}},
};

INSTANTIATE_TEST_SUITE_P(All, RotorMistakeTest, testing::ValuesIn(kRotorMistakes),
                         NameOfWrongModel);

constexpr std::string_view kChannels = R"(channels:
  states: {type: udp_json, sensors: {model: arm, rate: 50, to: "127.0.0.1:47010"}}
  efforts:
    type: udp_json
    commands: {model: arm, joints: [elbow, shoulder], listen: "127.0.0.1:47011", latency: 2ms}
  servos:
    type: dds
    commands:
      model: arm
      drive: position
      stiffness: [100, 200]
      damping: 7
      message: std_msgs/msg/Float64MultiArray
      topic: /commands
  joint_states:
    type: dds
    sensors: {model: arm, joints: [elbow], noise: {position: 0.01, effort: 2}, bias: {velocity: [0.5], effort: 3}, message: sensor_msgs/msg/JointState, topic: /joint_states}
)";

// A model with two joints comes before the arm.
std::string WithChannels() {
  std::string text(kGoodModels);
  text.insert(text.find("  arm:"),
              "  other: {urdf: arm.urdf, fixed_base: true, joints: {elbow: 1}}\n");
  return text + std::string(kChannels);
}

TEST(LoadJoints, ChannelsAreAboutJointsOfAModel) {
  const Folder folder;
  const Scenario scenario = Loaded(folder, WithChannels());
  ASSERT_EQ(scenario.sensors.size(), 2u);
  const JointGroup& states = scenario.sensors[0].joints.value();
  EXPECT_EQ(states.model, "arm");
  EXPECT_THAT(states.names, ElementsAre("shoulder", "elbow"));
  EXPECT_THAT(states.joints, ElementsAre(3, 4));  // after the three of the other one
  EXPECT_THAT(scenario.sensors[1].joints.value().joints, ElementsAre(4));
  const auto& errors = scenario.sensors[1].errors.joints;
  EXPECT_EQ(errors[static_cast<std::size_t>(JointQuantity::kPosition)].noise, 0.01);
  EXPECT_EQ(errors[static_cast<std::size_t>(JointQuantity::kVelocity)].bias[0], 0.5);
  EXPECT_EQ(errors[static_cast<std::size_t>(JointQuantity::kEffort)].noise, 2);
  EXPECT_EQ(errors[static_cast<std::size_t>(JointQuantity::kEffort)].bias_deviation, 3);
  ASSERT_EQ(scenario.commands.size(), 2u);
  const JointDriveSpec& efforts = scenario.commands[0].joints.value();
  EXPECT_THAT(efforts.group.joints, ElementsAre(4, 3));
  EXPECT_EQ(efforts.quantity, JointQuantity::kEffort);
  EXPECT_THAT(efforts.gains, ElementsAre(JointGains{}, JointGains{}));
  EXPECT_EQ(scenario.commands[0].latency, VirtualDuration::Milliseconds(2));
  const JointDriveSpec& servos = scenario.commands[1].joints.value();
  EXPECT_EQ(servos.quantity, JointQuantity::kPosition);
  EXPECT_THAT(servos.gains, ElementsAre(JointGains{100, 7}, JointGains{200, 7}));
}

class JointMistakeTest : public testing::TestWithParam<WrongModel> {};

TEST_P(JointMistakeTest, IsOneSentenceWithItsPlace) {
  const Folder folder;
  const WrongModel& mistake = GetParam();
  const std::string path =
      folder.Write("s.yaml", WithReplaced(mistake.from, mistake.to, WithChannels()));
  const std::string complaint = Complaint(folder, LoadScenario(path));
  EXPECT_THAT(complaint, StartsWith(std::string(mistake.place) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(complaint, HasSubstr(std::string(words)));
  }
}

const WrongModel kJointMistakes[] = {
    {"UnknownModel",
     "{model: arm, rate",
     "{model: amr, rate",
     "s.yaml:21",
     {"model 'amr'", "'arm'?"}},
    {"ModelWithoutJoints", "{model: arm, rate", "{model: crate, rate", "s.yaml:21", {"no joints"}},
    {"UnknownJoint",
     "[elbow, shoulder]",
     "[elbw, shoulder]",
     "s.yaml:24",
     {"joint 'elbw' of arm", "'elbow'?"}},
    {"FixedJoint",
     "[elbow, shoulder]",
     "[flange]",
     "s.yaml:24",
     {"'flange', which has 0 coordinates"}},
    {"JointTwice", "[elbow, shoulder]", "[elbow, elbow]", "s.yaml:24", {"a second time"}},
    {"ModelAndBodies",
     "{model: arm, rate: 50",
     "{model: arm, bodies: [x]",
     "s.yaml:21",
     {"beside bodies"}},
    {"LimitsOfJoints", "latency: 2ms", "limits: {force: 1}", "s.yaml:24", {"unknown key 'limits'"}},
    {"UnknownDrive",
     "drive: position",
     "drive: torque",
     "s.yaml:29",
     {"unknown 'torque'", "effort"}},
    {"PositionWithoutStiffness",
     "      stiffness: [100, 200]\n",
     "",
     "s.yaml:27",
     {"lacks the key 'stiffness'"}},
    {"VelocityWithoutDamping",
     "drive: position\n      stiffness: [100, 200]\n      damping: 7",
     "drive: velocity",
     "s.yaml:27",
     {"lacks the key 'damping'"}},
    {"TooFewGains", "[100, 200]", "[100]", "s.yaml:30", {"has 1 numbers; write 2"}},
    {"NegativeGain", "damping: 7", "damping: -7", "s.yaml:31", {"must not be negative"}},
    {"NegativeGainInAList", "[100, 200]", "[100, -2]", "s.yaml:30", {"below 0"}},
    {"WrenchOnJoints",
     "std_msgs/msg/Float64MultiArray",
     "geometry_msgs/msg/Wrench",
     "s.yaml:32",
     {"joints are driven by"}},
    {"OdometryOfJoints",
     "sensor_msgs/msg/JointState",
     "nav_msgs/msg/Odometry",
     "s.yaml:36",
     {"JointState"}},
};

INSTANTIATE_TEST_SUITE_P(All, JointMistakeTest, testing::ValuesIn(kJointMistakes),
                         NameOfWrongModel);

}  // namespace
}  // namespace tcs
