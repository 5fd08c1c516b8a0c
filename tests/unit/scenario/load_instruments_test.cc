// Sensors of robots and robots on wheels, as they are written and as they are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <ostream>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr auto Ms = VirtualDuration::Milliseconds;

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
constexpr std::string_view kGood = R"(duration: 1s
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
  const Scenario scenario = ScenarioOf(LoadScenario(folder_.Write("s.yaml", kGood)));
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
  EXPECT_EQ(lidar.least_m, 0.2);
  EXPECT_EQ(lidar.most_m, 8);
  // At the speed of a turn each 100 ms.
  EXPECT_NEAR(lidar.sweep.seconds(), 0.1 * 3 / (2 * std::numbers::pi), 1e-9);
  const FieldError& range =
      scenario.sensors[2].measurement_errors[static_cast<std::size_t>(MeasuredField::kRange)];
  EXPECT_EQ(range.noise, 0.01);
  EXPECT_EQ(range.bias[0], 0.05);
}

TEST_F(LoadInstruments, WithoutAnglesNoTwoRaysOfALidarLookTheSameWay) {
  const Scenario scenario = ScenarioOf(LoadScenario(
      folder_.Write("s.yaml", WithReplaced("rays: 181, angles: [-1.5, 1.5]", "rays: 4", kGood))));
  const auto& lidar = std::get<LidarSpec>(scenario.sensors[2].instrument.value());
  EXPECT_NEAR(lidar.first_rad, -std::numbers::pi, 1e-12);
  EXPECT_NEAR(lidar.last_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(lidar.sweep, Ms(75));
}

TEST_F(LoadInstruments, RobotsOnWheelsAreAsWritten) {
  const Scenario scenario = ScenarioOf(LoadScenario(folder_.Write("s.yaml", kGood)));
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

struct Mistake {
  const char* name;
  std::string_view from, to, place;
  std::vector<std::string_view> words;
};
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class InstrumentMistake : public LoadInstruments, public testing::WithParamInterface<Mistake> {};

TEST_P(InstrumentMistake, IsOneSentenceWithItsPlace) {
  const Mistake& mistake = GetParam();
  const std::string path = folder_.Write("s.yaml", WithReplaced(mistake.from, mistake.to, kGood));
  const std::string complaint = Complaint(folder_, LoadScenario(path));
  EXPECT_THAT(complaint, StartsWith(std::string(mistake.place) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(complaint, HasSubstr(std::string(words)));
  }
}

const Mistake kMistakes[] = {
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
     {"told its velocity by geometry_msgs/msg/Twist"}},
    {"TwistWithoutWheels",
     "drive: differential, left: left_joint, right: [right_joint], separation: 0.4, radius: 0.1, "
     "damping: 2",
     "drive: effort",
     "s.yaml:28",
     {"add drive: differential"}},
    {"LaserOfBodies",
     "sensors: {kind: odometry, on: cart, to: \"127.0.0.1:47010\"}",
     "sensors: {model: cart, to: \"127.0.0.1:47010\", kind: odometry}",
     "s.yaml:22",
     {"unknown key 'model'"}},
};
INSTANTIATE_TEST_SUITE_P(Of, InstrumentMistake, testing::ValuesIn(kMistakes),
                         [](const auto& mistake) { return mistake.param.name; });

}  // namespace
}  // namespace tcs
