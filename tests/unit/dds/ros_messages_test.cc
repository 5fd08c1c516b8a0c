// What a body does, in the frames and units that ROS 2 expects.
#include "coordinator/dds/ros_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "coordinator/dds/robot_topics.h"
#include "tests/unit/dds/samples.h"

namespace tcs::dds {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

constexpr double kTight = 1e-12;

// Turned left by 90 degrees: the body's x axis is the world's y axis.
BodyState TurnedLeft() {
  const double h = std::numbers::sqrt2 / 2;
  return {{1, 2, 3}, {0, 0, h, h}, {4, 5, 6}, {0.1, 0.2, 0.3}};
}

// Roll, then pitch, then yaw, about the world's axes.
std::array<double, 4> Orientation(double roll, double pitch, double yaw) {
  const double cr = std::cos(roll / 2), sr = std::sin(roll / 2);
  const double cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
  const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
  return {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
          cr * cp * cy + sr * sp * sy};
}

TEST(Odometry, HasThePoseInTheWorldAndTheTwistInTheBody) {
  const auto odometry = ToOdometry(kStamp, "hunter", TurnedLeft());
  EXPECT_EQ(odometry->header.stamp.sec, 1'700'000'000);
  EXPECT_EQ(odometry->header.stamp.nanosec, 250'000'000u);
  EXPECT_STREQ(odometry->header.frame_id, "world");
  EXPECT_STREQ(odometry->child_frame_id, "hunter");
  EXPECT_EQ(odometry->pose.pose.position.x, 1);
  EXPECT_EQ(odometry->pose.pose.position.y, 2);
  // What goes along the world's y is ahead, what goes along its x is to the right.
  EXPECT_THAT(odometry->twist.twist.linear.x, DoubleNear(5, kTight));
  EXPECT_THAT(odometry->twist.twist.linear.y, DoubleNear(-4, kTight));
  EXPECT_THAT(odometry->twist.twist.linear.z, DoubleNear(6, kTight));
  EXPECT_THAT(odometry->twist.twist.angular.x, DoubleNear(0.2, kTight));
  EXPECT_THAT(odometry->twist.twist.angular.y, DoubleNear(-0.1, kTight));
  for (const double c : odometry->pose.covariance) EXPECT_EQ(c, 0);
}

TEST(Odometry, AndImuSayHowUncertainTheyAre) {
  const BodyVariances variances{1, 2, 3, 4, 5, 6};
  const auto odometry = ToOdometry(kStamp, "hunter", TurnedLeft(), variances);
  const auto imu = ToImu(kStamp, "hunter", TurnedLeft(), {{}, std::array<double, 3>{}}, variances);
  for (int i = 0; i < 36; ++i) {
    EXPECT_EQ(odometry->pose.covariance[i], i % 7 != 0 ? 0 : i < 21 ? 1 : 2) << i;
    EXPECT_EQ(odometry->twist.covariance[i], i % 7 != 0 ? 0 : i < 21 ? 3 : 4) << i;
  }
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(imu->orientation_covariance[i], i % 4 == 0 ? 2 : 0) << i;
    EXPECT_EQ(imu->angular_velocity_covariance[i], i % 4 == 0 ? 5 : 0) << i;
    EXPECT_EQ(imu->linear_acceleration_covariance[i], i % 4 == 0 ? 6 : 0) << i;
  }
}

TEST(Twist, IsThatOfTheOdometry) {
  const auto twist = ToTwist(TurnedLeft());
  EXPECT_THAT(twist->linear.x, DoubleNear(5, kTight));
  EXPECT_THAT(twist->angular.y, DoubleNear(-0.1, kTight));
}

TEST(Clock, IsTheStamp) {
  EXPECT_EQ(ToClock(kStamp)->clock.sec, 1'700'000'000);
  EXPECT_EQ(ToClock(kStamp)->clock.nanosec, 250'000'000u);
}

// A sensor and its messages.
class ImuOf {
 public:
  ImuOf(std::string body, const std::array<double, 3>& gravity_mps2)
      : body_(std::move(body)), sensor_(gravity_mps2) {}
  Owned<ImuMessage> Sample(VirtualTime at, std::int64_t stamp_ns, const BodyState& state) {
    return ToImu(stamp_ns, body_, state, sensor_.Sample(at, state));
  }

 private:
  std::string body_;
  InertialSensor sensor_;
};

TEST(Imu, OfABodyHeldUpFeelsGravityUpwards) {
  ImuOf sensor("hunter", {0, 0, -9.8});
  BodyState still = TurnedLeft();
  (void)sensor.Sample(VirtualTime{}, kStamp, still);
  const auto imu = sensor.Sample(VirtualTime{} + VirtualDuration::Milliseconds(10), kStamp, still);
  EXPECT_STREQ(imu->header.frame_id, "hunter");
  EXPECT_THAT(imu->linear_acceleration.x, DoubleNear(0, kTight));
  EXPECT_THAT(imu->linear_acceleration.z, DoubleNear(9.8, kTight));
  EXPECT_EQ(imu->linear_acceleration_covariance[0], 0);
  EXPECT_EQ(imu->orientation.w, still.orientation_xyzw[3]);
  EXPECT_THAT(imu->angular_velocity.x, DoubleNear(0.2, kTight));
}

TEST(Imu, InFreeFallFeelsNothing) {
  ImuOf sensor("hunter", {0, 0, -9.8});
  BodyState falling = TurnedLeft();
  (void)sensor.Sample(VirtualTime{}, kStamp, falling);
  falling.linear_velocity_mps[2] -= 9.8 * 0.5;
  const auto imu =
      sensor.Sample(VirtualTime{} + VirtualDuration::Milliseconds(500), kStamp, falling);
  EXPECT_THAT(imu->linear_acceleration.z, DoubleNear(0, kTight));
}

TEST(Imu, TellsTheMeanAccelerationAlongTheBodysAxes) {
  ImuOf sensor("hunter", {});
  BodyState state = TurnedLeft();
  (void)sensor.Sample(VirtualTime{}, kStamp, state);
  state.linear_velocity_mps[1] += 0.03;
  const auto imu = sensor.Sample(VirtualTime{} + VirtualDuration::Milliseconds(10), kStamp, state);
  EXPECT_THAT(imu->linear_acceleration.x, DoubleNear(3, 1e-9));
  EXPECT_THAT(imu->linear_acceleration.y, DoubleNear(0, 1e-9));
}

TEST(Imu, SaysThatTheFirstSampleHasNoAcceleration) {
  ImuOf sensor("hunter", {0, 0, -9.8});
  const auto imu = sensor.Sample(VirtualTime{}, kStamp, TurnedLeft());
  EXPECT_EQ(imu->linear_acceleration_covariance[0], -1);
  EXPECT_EQ(imu->linear_acceleration.z, 0);
}

struct SixJoints {
  std::array<double, 6> position{}, velocity{};
};

SixJoints JointsOf(const BodyState& state) {
  const std::vector<std::string> bodies = {"b"};
  const auto message = ToJointState(kStamp, bodies, std::vector{state});
  SixJoints joints;
  EXPECT_EQ(message->position._length, 6u);
  EXPECT_EQ(message->velocity._length, 6u);
  EXPECT_EQ(message->effort._length, 0u);
  constexpr std::array kNames = {"b/x", "b/y", "b/z", "b/yaw", "b/pitch", "b/roll"};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_STREQ(message->name._buffer[i], kNames[i]);
    joints.position[i] = message->position._buffer[i];
    joints.velocity[i] = message->velocity._buffer[i];
  }
  return joints;
}

TEST(JointState, HasPlaceAndAngles) {
  BodyState state = TurnedLeft();
  state.orientation_xyzw = Orientation(0.3, -0.4, 2.5);
  const SixJoints joints = JointsOf(state);
  const std::array expected = {1.0, 2.0, 3.0, 2.5, -0.4, 0.3};
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_THAT(joints.position[i], DoubleNear(expected[i], kTight));
  EXPECT_EQ(joints.velocity[2], 6);
}

// The rates are the derivatives of the angles: turn a little, and compare.
TEST(JointState, HasTheRatesOfTheAngles) {
  constexpr double kStep = 1e-6;
  for (const double roll : {-2.0, 0.3}) {
    for (const double pitch : {-1.2, 0.4, 1.5}) {
      BodyState state;
      state.orientation_xyzw = Orientation(roll, pitch, 0.7);
      state.angular_velocity_radps = {0.4, -0.3, 0.2};
      const SixJoints before = JointsOf(state);
      // dq/dt = w q / 2, with w in the world's frame.
      const auto [x, y, z, w] = state.orientation_xyzw;
      const auto [wx, wy, wz] = state.angular_velocity_radps;
      const double half = kStep / 2;
      BodyState after_state = state;
      after_state.orientation_xyzw = {
          x + half * (wx * w + wy * z - wz * y), y + half * (wy * w + wz * x - wx * z),
          z + half * (wz * w + wx * y - wy * x), w - half * (wx * x + wy * y + wz * z)};
      const SixJoints after = JointsOf(after_state);
      for (std::size_t i = 3; i < 6; ++i) {
        EXPECT_THAT(before.velocity[i],
                    DoubleNear((after.position[i] - before.position[i]) / kStep, 1e-3))
            << "roll " << roll << ", pitch " << pitch << ", joint " << i;
      }
    }
  }
}

TEST(JointState, StraightUpIsFiniteAndCountsAsYaw) {
  BodyState state;
  state.orientation_xyzw = Orientation(0, std::numbers::pi / 2, 0.7);
  state.angular_velocity_radps = {1, 2, 3};
  const SixJoints joints = JointsOf(state);
  EXPECT_THAT(joints.position[3], DoubleNear(0.7, 1e-6));
  EXPECT_THAT(joints.position[4], DoubleNear(std::numbers::pi / 2, 1e-6));
  EXPECT_EQ(joints.position[5], 0);
  EXPECT_EQ(joints.velocity[3], 3);
  for (const double v : joints.velocity) EXPECT_TRUE(std::isfinite(v));
}

TEST(Wrench, IsTakenAsItIs) {
  Owned<WrenchMessage> message;
  *message = {{1, 2, 3}, {4, 5, 6}};
  const auto wrench = DecodeCommand(CommandMessage::kWrench, ToCdr(message));
  ASSERT_TRUE(std::holds_alternative<Wrench>(wrench));
  EXPECT_THAT(std::get<Wrench>(wrench).force_n, testing::ElementsAre(1, 2, 3));
  EXPECT_THAT(std::get<Wrench>(wrench).torque_nm, testing::ElementsAre(4, 5, 6));
}

TEST(Wrench, ThatIsNotFiniteIsRefused) {
  const auto complaint = [](double force, double torque) {
    Owned<WrenchMessage> message;
    message->force.y = force;
    message->torque.z = torque;
    const auto wrench = DecodeCommand(CommandMessage::kWrench, ToCdr(message));
    const auto* error = std::get_if<MessageError>(&wrench);
    return error == nullptr ? "" : error->message;
  };
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaint(infinite, 0), "has a force that is not finite");
  EXPECT_EQ(complaint(0, std::nan("")), "has a torque that is not finite");
  EXPECT_EQ(complaint(0, 0), "");
}

TEST(Wrench, OfForeignBytesIsRefused) {
  const auto wrench = DecodeCommand(CommandMessage::kWrench, EncodeClock(kStamp));
  ASSERT_TRUE(std::holds_alternative<MessageError>(wrench));
  EXPECT_THAT(std::get<MessageError>(wrench).message,
              HasSubstr("is no geometry_msgs::msg::dds_::Wrench_"));
}

TEST(SensorEncoder, SaysWhatItsMessageSays) {
  const std::vector<BodyState> states = {TurnedLeft()};
  const auto encode = [&](SensorMessage message) {
    const InertialReading felt = InertialSensor({0, 0, -9.8}).Sample(VirtualTime{}, states[0]);
    return SensorEncoder(message, {"hunter"}).Encode(kStamp, states, felt);
  };
  const std::vector<std::string> bodies = {"hunter"};
  EXPECT_EQ(encode(SensorMessage::kOdometry), ToCdr(ToOdometry(kStamp, "hunter", states[0])));
  EXPECT_EQ(encode(SensorMessage::kJointState), ToCdr(ToJointState(kStamp, bodies, states)));
  EXPECT_EQ(encode(SensorMessage::kTwist), ToCdr(ToTwist(states[0])));
  ImuOf sensor("hunter", {0, 0, -9.8});
  EXPECT_EQ(encode(SensorMessage::kImu), ToCdr(sensor.Sample(VirtualTime{}, kStamp, states[0])));
}

}  // namespace
}  // namespace tcs::dds
