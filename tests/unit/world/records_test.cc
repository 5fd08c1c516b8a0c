// What a run writes of its world: the scene, how joints stand, what was commanded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coordinator/world/commands.h"
#include "coordinator/world/contact_lines.h"
#include "coordinator/world/joint_lines.h"
#include "coordinator/world/scene_text.h"
#include "simbody_bridge/engines.h"

namespace tcs {
namespace {

using Json = nlohmann::json;

VirtualTime AtNs(std::int64_t ns) { return VirtualTime::FromNanoseconds(ns); }

// A cart with a mast that is fixed to it, and a wheel that turns at 2 rad/s.
RobotModel Cart() {
  RobotModel model;
  model.name = "cart";
  model.at.position_m = {1, 0, 0};
  const Inertial inertial{
      .mass_kg = 1, .frame = {}, .ixx_kgm2 = 0.01, .iyy_kgm2 = 0.01, .izz_kgm2 = 0.01};
  for (const char* name : {"base", "wheel", "mast"}) {
    Link link;
    link.name = name;
    link.inertial = inertial;
    model.links.push_back(link);
  }
  model.links[0].shapes.push_back(
      {.name = "hull", .geometry = BoxShape{{3, 2, 1}}, .pose = {.position_m = {0, 0, 5}}});
  Joint axle;
  axle.name = "axle";
  axle.kind = JointKind::kContinuous;
  axle.parent = 0;
  axle.child = 1;
  axle.axis = {0, 1, 0};
  axle.initial_velocity = {2};
  Joint weld;
  weld.name = "weld";
  weld.parent = 0;
  weld.child = 2;
  weld.origin.position_m = {0, 0, 7};
  model.joints = {weld, axle};
  return model;
}

class RecordsTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::string Written() const {
    std::stringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }
  const std::string path_ = testing::TempDir() + "records_test_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
};

TEST(SceneTest, HasAllThatIsToBeSeen) {
  Scenario scenario;
  scenario.world.emplace();
  scenario.world->bodies = {{.name = "drone", .mass_kg = 2}};
  scenario.world->has_region = true;
  scenario.world->region.half_extent_m = 10;
  scenario.world->fixtures = {{.name = "floor", .geometry = PlaneShape{}}};
  const auto mesh = std::make_shared<const Mesh>(
      Mesh{"stone.stl", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 1, 3}}});
  for (const double x : {1.0, 2.0}) {
    scenario.world->fixtures.push_back(
        {.name = "stone", .geometry = MeshShape{mesh}, .pose = {.position_m = {x, 0, 0}}});
  }
  RobotModel stone;
  stone.name = "stone";
  stone.links.resize(1);
  stone.links[0].name = "stone";
  scenario.world->models = {stone, Cart()};
  const std::string urdf = testing::TempDir() + "records_test.urdf";
  std::ofstream(urdf) << "<robot name='cart'><link name='mast'><visual><geometry><mesh "
                         "filename='mast.stl'/></geometry><material name='m'><color rgba='1 0.5 0 "
                         "1'/></material></visual></link></robot>";
  scenario.urdf_files["cart"] = urdf;
  scenario.urdf_packages["cart"] = {};
  SensorChannelSpec scan{.name = "scan"};
  scan.instrument = LidarSpec{.mount = {.link = 2, .at = {}, .frame = {}}, .rays = 9};
  scenario.sensors = {scan};
  const Json scene = Json::parse(SceneText(scenario));
  std::filesystem::remove(urdf);
  EXPECT_EQ(scene["region_m"], 10);
  EXPECT_EQ(scene["bodies"][0]["name"], "drone");
  EXPECT_EQ(scene["bodies"][0]["mass_kg"], 2);
  EXPECT_EQ(scene["fixtures"][0]["kind"], "plane");
  // What stands there twice is written once.
  ASSERT_EQ(scene["meshes"].size(), 1u);
  EXPECT_EQ(scene["meshes"][0]["triangles"][1], Json({0, 1, 3}));
  EXPECT_EQ(scene["fixtures"][2]["mesh"], 0);
  EXPECT_EQ(scene["fixtures"][2]["pose"], Json({2, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(scene["models"][0]["links"][0]["name"], "stone") << "the one link is its model";
  const Json& links = scene["models"][1]["links"];
  EXPECT_EQ(links[0]["name"], "cart/base");
  EXPECT_FALSE(links[0].contains("parent"));
  EXPECT_EQ(links[0]["shapes"][0]["size"], Json({3, 2, 1}));
  EXPECT_EQ(links[0]["shapes"][0]["pose"][2], 5);
  EXPECT_EQ(links[1]["kind"], "continuous");
  EXPECT_EQ(links[2]["kind"], "fixed");
  EXPECT_EQ(links[2]["parent"], 0);
  EXPECT_EQ(links[2]["pose"][2], 7);
  EXPECT_EQ(links[2]["visuals"][0]["name"], "mast.stl");
  EXPECT_EQ(links[2]["visuals"][0]["path"],
            (std::filesystem::path(urdf).parent_path() / "mast.stl").string());
  EXPECT_EQ(links[2]["visuals"][0]["colour"][1], 0.5);
  EXPECT_EQ(scene["sensors"][0]["link"], "cart/wheel");
  EXPECT_EQ(scene["sensors"][0]["rays"], 9);
}

TEST(SceneTest, WithoutAWorldThereIsNone) { EXPECT_EQ(SceneText(Scenario{}), ""); }

TEST_F(RecordsTest, JointsThatMoveHaveALineEach) {
  WorldSpec world;
  world.models = {Cart()};
  JointLines lines(world);
  CsvFile file;
  ASSERT_EQ(file.Open(path_, kJointsCsvHead), "");
  const auto dynamics = MakeDynamics(world);
  lines.Write(*dynamics, &file);
  dynamics->AdvanceTo(AtNs(10'000'000));
  lines.Write(*dynamics, &file);
  ASSERT_EQ(file.Close(), "");
  const std::string text = Written();
  EXPECT_TRUE(
      text.starts_with("time_s,joint,position,velocity,effort\n"
                       "0.000000000,cart/axle,0,2,0\n"
                       "0.010000000,cart/axle,0.0"))
      << text;
  EXPECT_EQ(text.find("weld"), std::string::npos);
}

TEST_F(RecordsTest, ContactsHaveALineEach) {
  WorldSpec world;
  world.gravity_mps2 = {0, 0, -9.81};
  world.fixtures = {{.name = "floor", .geometry = PlaneShape{}}};
  RobotModel ball;
  ball.name = "stone";
  ball.links = {
      {.name = "stone",
       .inertial =
           Inertial{.mass_kg = 1, .frame = {}, .ixx_kgm2 = 0.1, .iyy_kgm2 = 0.1, .izz_kgm2 = 0.1},
       .shapes = {{.geometry = SphereShape{0.5}}}}};
  ball.at.position_m = {1, 2, 0.5};
  RobotModel cart = Cart();
  cart.at.position_m = {1, 2, 9};
  world.models = {ball, cart};
  ContactLines lines(world);
  CsvFile file;
  ASSERT_EQ(file.Open(path_, kContactsCsvHead), "");
  const auto dynamics = MakeDynamics(world);
  lines.Write(*dynamics, &file);
  dynamics->AdvanceTo(AtNs(500'000'000));
  lines.Write(*dynamics, &file);
  ASSERT_EQ(file.Close(), "");
  std::istringstream text(Written());
  std::string head, line;
  std::getline(text, head);
  EXPECT_EQ(
      head,
      "time_s,first,second,x_m,y_m,z_m,normal_x,normal_y,normal_z,force_x_n,force_y_n,force_z_"
      "n");
  std::getline(text, line);
  EXPECT_TRUE(line.starts_with("0.500000000,stone,floor,")) << line;
  std::vector<double> numbers;
  std::istringstream rest(line.substr(std::string("0.500000000,stone,floor,").size()));
  for (std::string number; std::getline(rest, number, ',');) numbers.push_back(std::stod(number));
  const double wanted[] = {1, 2, 0, 0, 0, 1, 0, 0, 9.81};
  EXPECT_THAT(numbers, testing::Pointwise(testing::DoubleNear(2e-3), wanted));
  EXPECT_FALSE(std::getline(text, line)) << "the cart is in the air: " << line;
}

class CommandRecords : public RecordsTest {
 protected:
  Commands commands_{[](const std::string&) {},
                     [](VirtualTime, VirtualDuration, int, const Wrench&) {},
                     [](VirtualTime, VirtualDuration, int, const JointDrive&) {},
                     [](VirtualTime, VirtualDuration, int, double) {}};
};

TEST_F(CommandRecords, AreWhatIsGivenToThePhysics) {
  CommandChannelSpec thruster{.name = "thruster",
                              .body = 1,
                              .latency = VirtualDuration::Milliseconds(2),
                              .most_force_n = {1, 1, 1}};
  CommandChannelSpec arm{.name = "arm"};
  arm.joints = JointDriveSpec{.group = {"robot", {0, 1}, {"elbow", "wrist"}},
                              .gains = {{}, {}},
                              .limits = {JointLimits{.upper = 0.5}, JointLimits{}}};
  CommandChannelSpec motors{.name = "motors"};
  motors.rotors = RotorDriveSpec{.model = "drone",
                                 .rotors = {0},
                                 .names = {"left"},
                                 .most_radps = {800},
                                 .is_normalised = true};
  commands_.Open({thruster, arm, motors}, {"ship", "boat"});
  ASSERT_EQ(commands_.log().Open(path_), "");
  commands_.Take(0, AtNs(5), {.force_n = {7, 0, -0.25}, .torque_nm = {0, 0, 3}});
  const JointGoal goals[] = {{.joint = 0, .position = 9, .effort = 0.125},
                             {.joint = 1, .velocity = 4}};
  commands_.Take(1, AtNs(6), goals);
  const JointGoal spin[] = {{.joint = 0, .velocity = 0.5}};
  commands_.Take(2, AtNs(7), spin);
  ASSERT_EQ(commands_.log().Close(), "");
  EXPECT_EQ(Written(),
            "sent_ns,acts_ns,channel,target,quantity,value\n"
            "5,2000005,thruster,boat,force_x,1\n"
            "5,2000005,thruster,boat,force_y,0\n"
            "5,2000005,thruster,boat,force_z,-0.25\n"
            "5,2000005,thruster,boat,torque_x,0\n"
            "5,2000005,thruster,boat,torque_y,0\n"
            "5,2000005,thruster,boat,torque_z,3\n"
            "6,6,arm,robot/elbow,position,0.5\n"
            "6,6,arm,robot/elbow,effort,0.125\n"
            "6,6,arm,robot/wrist,velocity,4\n"
            "7,7,motors,drone/left,speed,400\n");
}

TEST_F(CommandRecords, OfWheelsAreHowTheRobotIsToGo) {
  CommandChannelSpec drive{.name = "drive"};
  drive.joints = JointDriveSpec{.group = {"rover", {0, 1}, {"left", "right"}}, .gains = {{}, {}}};
  drive.joints->wheels = WheelDriveSpec{
      .base = {}, .left = 1, .most_radps = 100, .timeout = VirtualDuration::Nanoseconds(50)};
  commands_.Open({drive});
  ASSERT_EQ(commands_.log().Open(path_), "");
  commands_.Take(0, AtNs(5), PlanarSpeed{.forward_mps = 1.5, .turn_radps = -1});
  commands_.ActUntil(AtNs(100));
  ASSERT_EQ(commands_.log().Close(), "");
  EXPECT_EQ(Written(),
            "sent_ns,acts_ns,channel,target,quantity,value\n"
            "5,5,drive,rover,forward,1.5\n5,5,drive,rover,turn,-1\n"
            "55,55,drive,rover,forward,0\n55,55,drive,rover,turn,0\n");
}

}  // namespace
}  // namespace tcs
