// Sensors of robots and robots on wheels, as they are written and as they are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <ostream>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::string_view kRobot = R"(<robot name="cart">
  <link name="base"/>
  <link name="hull"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="left"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="right"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="hull_joint" type="fixed"><parent link="base"/><child link="hull"/></joint>
  <joint name="left_joint" type="continuous"><parent link="hull"/><child link="left"/><axis xyz="0 1 0"/><limit effort="5" velocity="12"/></joint>
  <joint name="right_joint" type="continuous"><parent link="hull"/><child link="right"/><axis xyz="0 1 0"/></joint>
</robot>
)";

// Its lines are counted on below.
constexpr std::string_view kGoodInstruments = R"(duration: 1s
dynamics: {gravity: [0, 0, -9.81]}
models:
  crate: {box: [1, 1, 1], mass: 2, position: [5, 0, 1]}
  cart: {urdf: cart.urdf, at: {position: [0, 0, 1]}}
robots:
  r: {clients: {c: {command: [./controller]}}}
channels:
  imu:
    type: dds
    sensors:
      kind: imu
      on: cart/hull
      at: {position: [0.1, 0, 0.2]}
      frame: imu_link
      rate: 200
      noise: {angular_rate: 0.01}
      bias: {proper_acceleration: [0, 0, 0.1]}
      topic: /imu
  truth:
    type: udp_json
    sensors: {kind: odometry, on: cart, to: "127.0.0.1:47010"}
  scan:
    type: dds
    sensors: {kind: lidar, on: crate, rate: 10, rays: 181, angles: [-1.5, 1.5], range: [0.2, 8], noise: {range: 0.01}, bias: {range: [0.05]}, topic: /scan}
  drive:
    type: dds
    commands: {model: cart, drive: differential, left: left_joint, right: [right_joint], separation: 0.4, radius: 0.1, damping: 2, message: geometry_msgs/msg/Twist, topic: /cmd_vel}
)";

class LoadInstruments : public testing::Test {
 protected:
  LoadInstruments() { folder_.Write("cart.urdf", kRobot); }

  ScenarioFolder folder_;
};

TEST_F(LoadInstruments, AreAsWritten) {
  const Scenario scenario = ScenarioOf(LoadScenario(folder_.Write("s.yaml", kGoodInstruments)));
  ASSERT_EQ(scenario.sensors.size(), 3u);
  const SensorChannelSpec& imu = scenario.sensors[0];
  const Mount& mount = std::get<ImuSpec>(imu.instrument.value()).mount;
  EXPECT_EQ(mount.link, 2);  // after the crate and the cart's base
  EXPECT_THAT(mount.at.position_m, ElementsAre(0.1, 0, 0.2));
  EXPECT_EQ(mount.frame, "imu_link");
  EXPECT_EQ(imu.period, Ms(5));
  EXPECT_EQ(std::get<DdsSensorEnd>(imu.to).message, dds::SensorMessage::kImu);
  EXPECT_EQ(std::get<DdsSensorEnd>(imu.to).end.qos, dds::Qos());
  const auto error = [&imu](MeasuredField field) {
    return imu.measurement_errors[static_cast<std::size_t>(field)];
  };
  EXPECT_EQ(error(MeasuredField::kAngularRate).noise, 0.01);
  EXPECT_THAT(error(MeasuredField::kProperAcceleration).bias, ElementsAre(0, 0, 0.1));

  const auto& truth = std::get<TruthSpec>(scenario.sensors[1].instrument.value());
  EXPECT_EQ(truth.mount.link, 1);
  EXPECT_EQ(truth.mount.frame, "base");
  EXPECT_EQ(truth.world_frame, "world");

  const auto& lidar = std::get<LidarSpec>(scenario.sensors[2].instrument.value());
  EXPECT_EQ(lidar.mount.link, 0);
  EXPECT_EQ(lidar.rays, 181u);
  EXPECT_EQ(lidar.first_rad, -1.5);
  EXPECT_EQ(lidar.last_rad, 1.5);
  EXPECT_EQ(lidar.reach.least_m, 0.2);
  EXPECT_EQ(lidar.reach.most_m, 8);
  // At the speed of a turn each 100 ms.
  EXPECT_NEAR(lidar.sweep.seconds(), 0.1 * 3 / (2 * std::numbers::pi), 1e-9);
  const FieldError& range =
      scenario.sensors[2].measurement_errors[static_cast<std::size_t>(MeasuredField::kRange)];
  EXPECT_EQ(range.noise, 0.01);
  EXPECT_EQ(range.bias[0], 0.05);
}

TEST_F(LoadInstruments, WithoutAnglesNoTwoRaysOfALidarLookTheSameWay) {
  const Scenario scenario = ScenarioOf(LoadScenario(folder_.Write(
      "s.yaml", WithReplaced("rays: 181, angles: [-1.5, 1.5]", "rays: 4", kGoodInstruments))));
  const auto& lidar = std::get<LidarSpec>(scenario.sensors[2].instrument.value());
  EXPECT_NEAR(lidar.first_rad, -std::numbers::pi, 1e-12);
  EXPECT_NEAR(lidar.last_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(lidar.sweep, Ms(75));
}

TEST_F(LoadInstruments, RobotsOnWheelsAreAsWritten) {
  const Scenario scenario = ScenarioOf(LoadScenario(folder_.Write("s.yaml", kGoodInstruments)));
  const JointDriveSpec& joints = scenario.commands.at(0).joints.value();
  const WheelDriveSpec& wheels = joints.wheels.value();
  EXPECT_THAT(joints.group.names, ElementsAre("left_joint", "right_joint"));
  EXPECT_THAT(joints.gains, ElementsAre(JointGains{0, 2}, JointGains{0, 2}));
  EXPECT_EQ(wheels.left, 1u);
  EXPECT_EQ(wheels.base.separation_m, 0.4);
  EXPECT_EQ(wheels.base.radius_m, 0.1);
  EXPECT_EQ(wheels.most_radps, 12);
  EXPECT_EQ(wheels.timeout, Ms(500));
}

constexpr std::string_view kMore = R"(
  wheels: {type: dds, sensors: {kind: wheel_odometry, model: cart, left: left_joint, right: right_joint, separation: 0.5, radius: 0.2, child_frame: base, topic: /wheels}}
  tf: {type: dds, sensors: {kind: transforms, model: cart, world_frame: map, prefix: a/}}
  tf_static: {type: dds, sensors: {kind: fixed_transforms, model: cart}}
  description: {type: dds, sensors: {kind: description, model: cart, latency: 5ms}}
  points: {type: dds, sensors: {kind: lidar_3d, on: cart, rays: 10, layers: 4, elevations: [-0.1, 0.3], topic: /points}}
  sonar: {type: dds, sensors: {kind: range, on: cart, field_of_view: 0.4, radiation: infrared, topic: /sonar, qos: sensor_data}}
  depth: {type: dds, sensors: {kind: depth_camera, on: cart, width: 32, height: 24, topic: /depth}}
  fix: {type: dds, sensors: {kind: gnss, on: cart, origin: [48, 11, 500], noise: {position: 1.5}, topic: /fix}}
  mag: {type: dds, sensors: {kind: magnetometer, on: cart, field: [1e-5, 0, 0], topic: /mag}}
  baro: {type: dds, sensors: {kind: barometer, on: cart, ground: 100000, topic: /baro}}
  bump: {type: dds, sensors: {kind: contact, on: cart/hull, margin: 0.01, topic: /bump}}
  follow: {type: dds, commands: {model: cart, drive: trajectory, stiffness: 5, rate: 50, message: trajectory_msgs/msg/JointTrajectory, topic: /follow}}
)";

TEST_F(LoadInstruments, AllKindsAreAsWritten) {
  const Scenario scenario = ScenarioOf(LoadScenario(
      folder_.Write("s.yaml", std::string(kGoodInstruments) + std::string(kMore).substr(1))));
  ASSERT_EQ(scenario.sensors.size(), 14u);
  const auto spec = [&](std::size_t i) { return scenario.sensors[i].instrument.value(); };
  const auto end = [&](std::size_t i) { return std::get<DdsSensorEnd>(scenario.sensors[i].to); };
  const auto wheels = std::get<WheelOdometrySpec>(spec(3));
  EXPECT_THAT(wheels.joints, ElementsAre(1, 2));
  EXPECT_EQ(wheels.left, 1u);
  EXPECT_EQ(wheels.base.radius_m, 0.2);
  EXPECT_EQ(wheels.frame, "odom");
  EXPECT_EQ(wheels.child_frame, "base");
  const auto transforms = std::get<TransformsSpec>(spec(4));
  ASSERT_EQ(transforms.pairs.size(), 3u);
  EXPECT_EQ(transforms.pairs[0].parent, -1);
  EXPECT_EQ(transforms.pairs[0].parent_frame, "map");
  EXPECT_EQ(transforms.pairs[1].parent_frame, "a/hull");
  EXPECT_EQ(transforms.pairs[1].child, 3);
  EXPECT_EQ(end(4).end.topic, "/tf");
  EXPECT_EQ(end(4).end.qos, dds::Qos());
  EXPECT_EQ(std::get<FixedTransformsSpec>(spec(5)).transforms.pairs.size(), 1u);
  EXPECT_EQ(end(5).end.topic, "/tf_static");
  EXPECT_EQ(end(5).end.qos.durability, dds::Durability::kTransientLocal);
  EXPECT_EQ(scenario.sensors[5].period, VirtualDuration{});
  EXPECT_EQ(std::get<DescriptionSpec>(spec(6)).text, kRobot);
  EXPECT_EQ(end(6).end.topic, "/robot_description");
  EXPECT_EQ(scenario.sensors[6].latency, Ms(5));
  const auto points = std::get<Lidar3dSpec>(spec(7));
  EXPECT_EQ(points.layers, 4u);
  EXPECT_EQ(points.lowest_rad, -0.1);
  EXPECT_EQ(points.lidar.rays, 10u);
  EXPECT_TRUE(std::get<RangeSpec>(spec(8)).is_infrared);
  EXPECT_EQ(end(8).end.qos.reliability, dds::Reliability::kBestEffort);
  EXPECT_EQ(end(8).end.qos.depth, 5);
  EXPECT_EQ(std::get<DepthCameraSpec>(spec(9)).height, 24u);
  EXPECT_EQ(std::get<GnssSpec>(spec(10)).origin, (Geodetic{48, 11, 500}));
  EXPECT_EQ(std::get<MagnetometerSpec>(spec(11)).field_t[0], 1e-5);
  EXPECT_EQ(std::get<BarometerSpec>(spec(12)).ground_pa, 100'000);
  EXPECT_EQ(std::get<ContactSpec>(spec(13)).margin_m, 0.01);
  EXPECT_EQ(scenario.commands.at(1).joints->setpoint_period, Ms(20));
}

struct WrongInstrument {
  const char* name;
  std::string_view from, to, place;
  std::vector<std::string_view> words;
};
void PrintTo(const WrongInstrument& mistake, std::ostream* out) { *out << mistake.name; }

class InstrumentMistake : public LoadInstruments,
                          public testing::WithParamInterface<WrongInstrument> {};

TEST_P(InstrumentMistake, IsOneSentenceWithItsPlace) {
  const WrongInstrument& mistake = GetParam();
  const std::string path =
      folder_.Write("s.yaml", WithReplaced(mistake.from, mistake.to, kGoodInstruments));
  const std::string complaint = Complaint(folder_, LoadScenario(path));
  EXPECT_THAT(complaint, StartsWith(std::string(mistake.place) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(complaint, HasSubstr(std::string(words)));
  }
}

class MoreMistakes : public LoadInstruments, public testing::WithParamInterface<WrongInstrument> {};

TEST_P(MoreMistakes, AreOneSentenceWithItsPlace) {
  const WrongInstrument& mistake = GetParam();
  const std::string text = std::string(kGoodInstruments) + std::string(kMore).substr(1);
  const std::string path = folder_.Write("s.yaml", WithReplaced(mistake.from, mistake.to, text));
  const std::string complaint = Complaint(folder_, LoadScenario(path));
  EXPECT_THAT(complaint, StartsWith(std::string(mistake.place) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(complaint, HasSubstr(std::string(words)));
  }
}

const WrongInstrument kMoreMistakes[] = {
    {"TransformsOfABox",
     "kind: transforms, model: cart, world_frame: map",
     "kind: transforms, model: crate",
     "s.yaml:30",
     {"no joint that is not fixed"}},
    {"RateOfWhatIsSaidOnce",
     "kind: fixed_transforms, model: cart",
     "kind: fixed_transforms, model: cart, rate: 5",
     "s.yaml:31",
     {"unknown key 'rate'"}},
    {"DescriptionOfABox",
     "kind: description, model: cart",
     "kind: description, model: crate",
     "s.yaml:32",
     {"comes from no file"}},
    {"CloudInADatagram",
     "type: dds, sensors: {kind: lidar_3d, on: cart, rays: 10, layers: 4, elevations: [-0.1, 0.3], "
     "topic: "
     "/points}",
     "type: udp_json, sensors: {kind: lidar_3d, on: cart, to: \"127.0.0.1:47011\"}",
     "s.yaml:33",
     {"make the channel's type dds"}},
    {"TooManyRays", "rays: 10, layers: 4", "rays: 100000, layers: 40", "s.yaml:33", {"a million"}},
    {"BeyondStraightUp", "[-0.1, 0.3]", "[-0.1, 3]", "s.yaml:33", {"straight up"}},
    {"WideCone", "field_of_view: 0.4", "field_of_view: 4", "s.yaml:34", {"half a turn"}},
    {"UnknownRadiation", "infrared", "infrred", "s.yaml:34", {"'infrared'?"}},
    {"UnknownProfile", "sensor_data", "sensors_data", "s.yaml:34", {"'sensor_data'?"}},
    {"LargeImage", "width: 32", "width: 3200", "s.yaml:35", {"width"}},
    {"NotOnEarth", "[48, 11, 500]", "[148, 11, 500]", "s.yaml:36", {"not on the earth"}},
    {"NoOrigin", "origin: [48, 11, 500], ", "", "s.yaml:36", {"lacks the key 'origin'"}},
    {"NoPressure", "ground: 100000", "ground: 0", "s.yaml:38", {"ground"}},
    {"NegativeMargin", "margin: 0.01", "margin: -0.01", "s.yaml:39", {"margin"}},
    {"TrajectoryAsNumbers",
     "trajectory_msgs/msg/JointTrajectory",
     "std_msgs/msg/Float64MultiArray",
     "s.yaml:40",
     {"trajectories are told by trajectory_msgs/msg/JointTrajectory"}},
    {"NumbersAsTrajectory",
     "drive: trajectory, stiffness: 5, rate: 50",
     "drive: effort",
     "s.yaml:40",
     {"wants drive: trajectory"}},
    {"TrajectoryWithoutStiffness",
     "stiffness: 5, ",
     "",
     "s.yaml:40",
     {"lacks the key 'stiffness'"}},
};
INSTANTIATE_TEST_SUITE_P(Of, MoreMistakes, testing::ValuesIn(kMoreMistakes),
                         [](const auto& mistake) { return mistake.param.name; });

const WrongInstrument kWrongInstruments[] = {
    {"UnknownKind", "kind: imu", "kind: imus", "s.yaml:12", {"unknown 'imus'", "'imu'?"}},
    {"UnknownLink",
     "on: cart/hull",
     "on: cart/hul",
     "s.yaml:13",
     {"link 'hul' of cart", "'hull'?"}},
    {"UnknownModel", "on: cart/hull", "on: crat/hull", "s.yaml:13", {"model 'crat'", "'crate'?"}},
    {"NotMounted", "      on: cart/hull\n", "", "s.yaml:11", {"lacks the key 'on'"}},
    {"KeyOfAnotherKind", "rate: 200", "rays: 200", "s.yaml:16", {"unknown key 'rays'"}},
    {"NoiseOfAnotherKind", "{angular_rate: 0.01}", "{range: 0.01}", "s.yaml:17", {"'range'"}},
    {"OtherMessage",
     "topic: /imu",
     "topic: /imu\n      message: nav_msgs/msg/Odometry",
     "s.yaml:20",
     {"writes sensor_msgs/msg/Imu"}},
    {"ReachBackwards", "range: [0.2, 8]", "range: [8, 0.2]", "s.yaml:25", {"least and the most"}},
    {"MoreThanATurn", "[-1.5, 1.5]", "[-4, 4]", "s.yaml:25", {"more than a whole turn"}},
    {"SweepBeyondPeriod",
     "rays: 181",
     "sweep: 200ms",
     "s.yaml:25",
     {"longer than the time between two scans"}},
    {"NoRays", "rays: 181", "rays: 0", "s.yaml:25", {"rays"}},
    {"NoSeparation", "separation: 0.4, ", "", "s.yaml:28", {"lacks the key 'separation'"}},
    {"RadiusZero", "radius: 0.1", "radius: 0", "s.yaml:28", {"radius"}},
    {"WheelTwice", "[right_joint]", "[left_joint]", "s.yaml:28", {"a second time"}},
    {"UnknownWheel", "[right_joint]", "[rigt_joint]", "s.yaml:28", {"'right_joint'?"}},
    {"WheelsWithoutTwist",
     "geometry_msgs/msg/Twist",
     "std_msgs/msg/Float64MultiArray",
     "s.yaml:28",
     {"told by geometry_msgs/msg/Twist"}},
    {"TwistWithoutWheels",
     "drive: differential, left: left_joint, right: [right_joint], separation: 0.4, radius: 0.1, "
     "damping: 2",
     "drive: effort",
     "s.yaml:28",
     {"wants drive: differential"}},
    {"LaserOfBodies",
     "sensors: {kind: odometry, on: cart, to: \"127.0.0.1:47010\"}",
     "sensors: {model: cart, to: \"127.0.0.1:47010\", kind: odometry}",
     "s.yaml:22",
     {"unknown key 'model'"}},
};
INSTANTIATE_TEST_SUITE_P(Of, InstrumentMistake, testing::ValuesIn(kWrongInstruments),
                         [](const auto& mistake) { return mistake.param.name; });

}  // namespace
}  // namespace tcs
