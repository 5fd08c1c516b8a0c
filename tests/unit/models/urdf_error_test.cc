// Every mistake in a robot's description is one sentence that begins with its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr std::string_view kGood = R"(<?xml version="1.0"?>
<robot name="crane" version="1.0">
  <material name="red"/>
  <link name="base">
    <visual/>
    <collision><geometry><box size="1 1 0.1"/></geometry></collision>
  </link>
  <link name="boom">
    <inertial>
      <origin xyz="0 0 0.5" rpy="0 0 0"/>
      <mass value="2.0"/>
      <inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.1"/>
    </inertial>
    <collision name="shell">
      <origin xyz="0 0 0.5"/>
      <geometry><cylinder radius="0.1" length="1"/></geometry>
    </collision>
  </link>
  <joint name="mast" type="revolute">
    <origin xyz="0 0 0.1"/>
    <parent link="base"/>
    <child link="boom"/>
    <axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="10" velocity="2"/>
    <dynamics damping="0.1" friction="0.01"/>
  </joint>
  <link name="hook">
    <inertial><mass value="0.5"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
  </link>
  <joint name="trolley" type="prismatic">
    <parent link="boom"/>
    <child link="hook"/>
    <axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="10" velocity="2"/>
    <mimic joint="mast" multiplier="0.5" offset="0.1"/>
  </joint>
</robot>
)";

std::string With(std::string_view from, std::string_view to) {
  std::string text(kGood);
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) {
    throw std::logic_error("not once in the robot: " + std::string(from));
  }
  return text.replace(at, from.size(), to);
}

TEST(Urdf, ThatIsSoundIsTakenWithoutAWord) {
  const ModelFolder folder;
  const Loaded loaded = LoadText(folder, kGood, {true});
  EXPECT_EQ(loaded.mistake, "");
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

struct Mistake {
  std::string_view name;
  std::string_view from;  // in kGood
  std::string_view to;
  int line;
  std::vector<std::string_view> words;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class UrdfMistakeTest : public testing::TestWithParam<Mistake> {
 protected:
  // Whatever the machine has: here there is no xacro.
  UrdfMistakeTest() { setenv("PATH", "/nowhere", 1); }
  ~UrdfMistakeTest() override { setenv("PATH", path_.c_str(), 1); }

 private:
  const std::string path_ = getenv("PATH");
};

TEST_P(UrdfMistakeTest, IsOneSentenceWithItsPlace) {
  const ModelFolder folder;
  const Mistake& mistake = GetParam();
  testing::internal::CaptureStderr();
  const Loaded loaded = LoadText(folder, With(mistake.from, mistake.to), {true});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(loaded.mistake, StartsWith("robot.urdf:" + std::to_string(mistake.line) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(loaded.mistake, HasSubstr(std::string(words)));
  }
}

const Mistake kFileMistakes[] = {
    {"NoXml", kGood, "duration: 20s\n", 1, {"not valid XML"}},
    {"Empty", kGood, "", 1, {"not valid XML", "no element"}},
    {"OnlyAComment", kGood, "<!-- nothing -->", 1, {"no <robot>"}},
    {"Unclosed", "</robot>", "", 2, {"not valid XML", "not closed"}},
    {"CrossedEnds", "<visual/>", "<visual>", 5, {"not valid XML", "another name"}},
    {"AttributeTwice",
     "<axis xyz=\"0 0 1\"/>",
     "<axis xyz=\"0 0 1\" xyz=\"1 0 0\"/>",
     23,
     {"twice"}},
    {"Sdf", kGood, "<sdf version='1.7'><model/></sdf>", 1, {"Gazebo's SDF", "URDF"}},
    {"Mjcf", kGood, "<mujoco/>", 1, {"MuJoCo's MJCF"}},
    {"OtherRoot", kGood, "<!-- x -->\n<bot/>", 2, {"'bot'", "<robot>"}},
    {"SecondRoot", "</robot>\n", "</robot>\n<robot/>", 38, {"second element"}},
    {"Xacro",
     "  <material name=\"red\"/>",
     "  <xacro:include filename=\"x\"/>",
     3,
     {"xacro is not expanded", "`xacro robot.urdf > robot.expanded.urdf`"}},
    {"XacroValue", "value=\"2.0\"", "value=\"${mass}\"", 11, {"xacro is not expanded"}},
    {"DocumentTypeWithEntities",
     "<?xml version=\"1.0\"?>",
     "<!DOCTYPE robot [<!ENTITY a \"b\">]>",
     1,
     {"document type", "remove it"}},
};

const Mistake kLinkMistakes[] = {
    {"NoLinkName", "<link name=\"hook\">", "<link>", 27, {"this <link> has no name"}},
    {"EmptyLinkName", "<link name=\"hook\">", "<link name=\"\">", 27, {"must be a name"}},
    {"LineEndInName", "<link name=\"hook\">", "<link name=\"ho&#10;ok\">", 27, {"'ho\\nok'"}},
    {"LinkTwice",
     "<link name=\"hook\">",
     "<link name=\"boom\">",
     27,
     {"second link", "'boom'", "line 8"}},
    {"NoMass", "      <mass value=\"2.0\"/>\n", "", 9, {"<inertial> in link 'boom' has no <mass>"}},
    {"MassIsNoNumber", "\"2.0\"", "\"heavy\"", 11, {"value of <mass> in link 'boom' is 'heavy'"}},
    {"MassIsNan", "\"2.0\"", "\"nan\"", 11, {"'nan'", "finite"}},
    {"MassIsInfinite", "\"2.0\"", "\"inf\"", 11, {"'inf'", "finite"}},
    {"MassOverflows", "\"2.0\"", "\"1e999\"", 11, {"'1e999'", "finite"}},
    {"MassWithUnit", "\"2.0\"", "\"2.0 kg\"", 11, {"'2.0 kg'", "finite number"}},
    {"NegativeMass", "\"2.0\"", "\"-2\"", 11, {"'-2'", "0 or more"}},
    {"MassWithoutValue",
     "<mass value=\"2.0\"/>",
     "<mass/>",
     11,
     {"<mass> in link 'boom' has no value"}},
    {"InertiaLacksAnElement", "ixx=\"0.2\" ", "", 12, {"<inertia> in link 'boom' has no ixx"}},
    {"TwoNumbersForThree",
     "xyz=\"0 0 0.5\" rpy",
     "xyz=\"0 0.5\" rpy",
     10,
     {"xyz of <origin>", "three"}},
    {"WordInThree", "rpy=\"0 0 0\"", "rpy=\"0 0 pi\"", 10, {"'0 0 pi'", "three finite numbers"}},
    {"NoGeometry",
     "<geometry><box size=\"1 1 0.1\"/></geometry>",
     "",
     6,
     {"<collision> in link 'base' has no <geometry>"}},
    {"EmptyGeometry",
     "<box size=\"1 1 0.1\"/>",
     "",
     6,
     {"<geometry> in link 'base' is empty", "box"}},
    {"UnknownShape",
     "<box size=\"1 1 0.1\"/>",
     "<boxx size=\"1 1 0.1\"/>",
     6,
     {"unknown shape 'boxx'", "did you mean 'box'?"}},
    {"TwoShapes",
     "<box size=\"1 1 0.1\"/>",
     "<box size=\"1 1 1\"/><sphere radius=\"1\"/>",
     6,
     {"more than one shape"}},
    {"NegativeRadius",
     "radius=\"0.1\"",
     "radius=\"-0.1\"",
     16,
     {"radius of <cylinder>", "0 or more"}},
    {"NoSuchMesh",
     "<box size=\"1 1 0.1\"/>",
     "<mesh filename=\"none.stl\"/>",
     6,
     {"link 'base'", "none.stl: cannot be read: No such file"}},
    {"NoSuchPackage",
     "<box size=\"1 1 0.1\"/>",
     "<mesh filename=\"package://none/a.stl\"/>",
     6,
     {"link 'base'", "package 'none'"}},
    {"MeshOfAnotherKind",
     "<box size=\"1 1 0.1\"/>",
     "<mesh filename=\"robot.urdf\"/>",
     6,
     {"not a mesh that tcs reads", ".stl, .obj, .dae or .glb"}},
    {"MeshIsAFolder",
     "<box size=\"1 1 0.1\"/>",
     "<mesh filename=\"/tmp/.stl\"/>",
     6,
     {"link 'base'"}},
};

const Mistake kJointMistakes[] = {
    {"NoType", " type=\"revolute\"", "", 19, {"this <joint> has no type"}},
    {"UnknownType",
     "\"revolute\"",
     "\"revolut\"",
     19,
     {"unknown type 'revolut'", "did you mean 'revolute'?"}},
    {"BallType", "\"revolute\"", "\"ball\"", 19, {"unknown type 'ball'", "types here are fixed"}},
    {"JointTwice", "\"trolley\"", "\"mast\"", 30, {"second joint", "'mast'", "line 19"}},
    {"NoParent", "    <parent link=\"base\"/>\n", "", 19, {"joint 'mast' has no <parent>"}},
    {"NoChild", "    <child link=\"boom\"/>\n", "", 19, {"joint 'mast' has no <child>"}},
    {"NoSuchParent",
     "<parent link=\"base\"/>",
     "<parent link=\"bas\"/>",
     21,
     {"joint 'mast' has the parent 'bas'", "did you mean 'base'?"}},
    {"NoSuchChild",
     "<child link=\"boom\"/>",
     "<child link=\"x\"/>",
     22,
     {"child 'x', but there is no such"}},
    {"NoDirection", "<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>", 19, {"no direction"}},
    {"NegativeDamping",
     "damping=\"0.1\"",
     "damping=\"-0.1\"",
     25,
     {"damping of <dynamics>", "0 or more"}},
    {"MimicsItself", "mimic joint=\"mast\"", "mimic joint=\"trolley\"", 35, {"follows itself"}},
    {"TwoRoots",
     "<parent link=\"boom\"/>\n    <child link=\"hook\"/>",
     "<parent link=\"base\"/>\n    <child link=\"boom\"/>",
     8,
     {"child of joint 'mast' and of joint 'trolley'"}},
    {"JointOnItself", "<parent link=\"boom\"/>", "<parent link=\"hook\"/>", 27, {"loop", "'hook'"}},
    {"LoopWithoutARoot",
     "</robot>",
     "<joint name=\"back\" type=\"fixed\"><parent link=\"hook\"/><child "
     "link=\"base\"/></joint></robot>",
     4,
     {"loop", "joint 'back'"}},
};

std::string NameOf(const testing::TestParamInfo<Mistake>& info) {
  return std::string(info.param.name);
}
INSTANTIATE_TEST_SUITE_P(File, UrdfMistakeTest, testing::ValuesIn(kFileMistakes), NameOf);
INSTANTIATE_TEST_SUITE_P(Links, UrdfMistakeTest, testing::ValuesIn(kLinkMistakes), NameOf);
INSTANTIATE_TEST_SUITE_P(Joints, UrdfMistakeTest, testing::ValuesIn(kJointMistakes), NameOf);

TEST(Urdf, AllMistakesAreSaidInTheOrderOfTheirLines) {
  const ModelFolder folder;
  std::string text = With("value=\"2.0\"", "value=\"heavy\"");
  text.replace(text.find("link=\"base\""), 11, "link=\"bass\"");
  text.replace(text.find("\"prismatic\""), 11, "\"sliding\"");
  text.replace(text.find("rpy=\"0 0 0\""), 11, "rpy=\"0 0\"");
  EXPECT_THAT(LoadText(folder, text, {true}).mistakes,
              ElementsAre(HasSubstr(":10: rpy of <origin>"), HasSubstr(":11: value of <mass>"),
                          HasSubstr(":21: joint 'mast' has the parent 'bass'"),
                          HasSubstr(":30: joint 'trolley' has the unknown type 'sliding'")));
}

// Both meshes cannot be had.
TEST(Urdf, AllMissingMeshesAreSaid) {
  const ModelFolder folder;
  std::string text = With("<box size=\"1 1 0.1\"/>", "<mesh filename=\"none.stl\"/>");
  const std::string_view cylinder = "<cylinder radius=\"0.1\" length=\"1\"/>";
  text.replace(text.find(cylinder), cylinder.size(), "<mesh filename=\"package://none/b.stl\"/>");
  EXPECT_THAT(LoadText(folder, text, {true}).mistakes,
              ElementsAre(HasSubstr(":6: link 'base': "), HasSubstr(":16: link 'boom': ")));
}

TEST(Urdf, AFreeRootWithoutMassIsFixedToTheWorld) {
  const ModelFolder folder;
  EXPECT_THAT(LoadText(folder, kGood, {true}).warnings, IsEmpty());
  const Loaded loaded = LoadText(folder, kGood, {false});
  EXPECT_EQ(loaded.mistake, "");
  EXPECT_TRUE(loaded.model.has_fixed_base);
  EXPECT_THAT(
      loaded.warnings,
      ElementsAre("robot.urdf:4: link 'base' is the root and has no mass, so it is fixed to "
                  "the world; write fixed_base: true in the scenario, or give it an "
                  "inertial"));
}

struct Oddity {
  std::string_view name;
  std::string_view from;
  std::string_view to;
  std::string_view sentence;
};

void PrintTo(const Oddity& oddity, std::ostream* out) { *out << oddity.name; }

class UrdfOddityTest : public testing::TestWithParam<Oddity> {};

TEST_P(UrdfOddityTest, IsSaidOnceAndLeftOut) {
  const ModelFolder folder;
  const Oddity& oddity = GetParam();
  const Loaded loaded = LoadText(folder, With(oddity.from, oddity.to), {true});
  EXPECT_EQ(loaded.mistake, "");
  EXPECT_THAT(loaded.warnings, ElementsAre(std::string(oddity.sentence)));
}

std::string OddityLabel(const testing::TestParamInfo<Oddity>& info) {
  return std::string(info.param.name);
}

const Oddity kOddities[] = {
    {"Sensor", "<visual/>", "<sensor/>", "robot.urdf:5: <sensor> is not understood and left out"},
    {"ManyOfAKind", "<material name=\"red\"/>", "<gazebo/>\n<gazebo/><gazebo/>",
     "robot.urdf:3: <gazebo> is not understood and left out, as are 2 more of its kind"},
    {"Misspelt", "<dynamics damping=\"0.1\" friction=\"0.01\"/>", "<dynamic damping=\"1\"/>",
     "robot.urdf:25: <dynamic> is not understood and left out; did you mean 'dynamics'?"},
    {"MisspeltAttribute", "friction=\"0.01\"", "frictoin=\"0.01\"",
     "robot.urdf:25: the attribute 'frictoin' of <dynamics> is not understood and left out; did "
     "you "
     "mean 'friction'?"},
    {"AnotherVersion", "crane\" version=\"1.0\"", "crane\" version=\"1.2\"",
     "robot.urdf:2: the attribute 'version' of <robot> is not understood and left out"},
    {"ControlCharacters", "<visual/>", "<a\xc2\x9b/>",
     "robot.urdf:5: <a\\xc2\\x9b> is not understood and left out"},
};

INSTANTIATE_TEST_SUITE_P(All, UrdfOddityTest, testing::ValuesIn(kOddities), OddityLabel);

TEST(Urdf, ALimitOfAJointThatHasNoneIsSaidAndLeftOut) {
  const ModelFolder folder;
  std::string text = With("<mimic joint=\"mast\" multiplier=\"0.5\" offset=\"0.1\"/>", "");
  text.replace(text.find("revolute"), 8, "planar");
  const Loaded loaded = LoadText(folder, text, {true});
  EXPECT_EQ(loaded.mistake, "");
  EXPECT_THAT(
      loaded.warnings,
      ElementsAre("robot.urdf:19: joint 'mast' has a <limit>, which means nothing for a joint "
                  "of its type and is left out"));
}

TEST(Urdf, NumbersMayStandAsInXml) {
  const ModelFolder folder;
  const Loaded loaded =
      LoadText(folder, With("xyz=\"0 0 0.5\" rpy", "xyz=\"\n 1.\t+2e-1  \r\n-.5 \" rpy"), {true});
  EXPECT_EQ(loaded.mistake, "");
  EXPECT_EQ(LinkNamed(loaded.model, "boom").inertial.value().frame.position_m,
            (std::array<double, 3>{1, 0.2, -0.5}));
}

TEST(Urdf, AContinuousJointHasNoRangeWhateverItsLimitSays) {
  const ModelFolder folder;
  std::string text = With("\"revolute\"", "\"continuous\"");
  text.erase(text.find("    <mimic"),
             text.find("/>", text.find("<mimic")) + 2 - text.find("    <mimic"));
  const Loaded loaded = LoadText(folder, text, {true});
  EXPECT_EQ(loaded.mistake, "");
  const JointLimits& limits = JointNamed(loaded.model, "mast").limits;
  EXPECT_EQ(limits.lower, -kNoLimit);
  EXPECT_EQ(limits.effort, 10);
}

TEST(Urdf, AFileThatIsNotThereIsNamed) {
  EXPECT_EQ(LoadFile("/none/robot.urdf").mistake,
            "/none/robot.urdf: cannot be read: No such file or directory; give the path of a URDF "
            "file");
  EXPECT_THAT(LoadFile("/tmp").mistake, HasSubstr("/tmp: is not a regular file"));
}

}  // namespace
}  // namespace tcs
