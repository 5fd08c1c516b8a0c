#include "coordinator/dds/ros_messages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coordinator/dds/ros_fields.h"

namespace tcs::dds {
namespace {

constexpr std::string_view kWorldFrame = "world";
constexpr std::array kJoints = {"/x", "/y", "/z", "/yaw", "/pitch", "/roll"};
// Below this cosine of the pitch (the nose within some 0.06 mrad of straight up), roll and yaw
// cannot be told apart in doubles.
constexpr double kUpright = 6e-5;

TwistMessage TwistInBody(const BodyState& state) {
  return {ToVector3(InBody(state.orientation_xyzw, state.linear_velocity_mps)),
          ToVector3(InBody(state.orientation_xyzw, state.angular_velocity_radps))};
}

struct Angles {
  double yaw = 0, pitch = 0, roll = 0;                 // rad
  double yaw_rate = 0, pitch_rate = 0, roll_rate = 0;  // rad/s
};

Angles ToAngles(const BodyState& state) {
  const auto& [x, y, z, w] = state.orientation_xyzw;
  const auto& [wx, wy, wz] = state.angular_velocity_radps;
  Angles angles;
  angles.pitch = std::asin(std::clamp(2 * (w * y - x * z), -1.0, 1.0));
  const double cosine = std::cos(angles.pitch);
  if (cosine < kUpright) {
    angles.yaw = std::atan2(2 * (w * z - x * y), 1 - 2 * (x * x + z * z));
    angles.yaw_rate = wz;
    angles.pitch_rate = std::cos(angles.yaw) * wy - std::sin(angles.yaw) * wx;
    return angles;
  }
  angles.yaw = std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  angles.roll = std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
  const double along = std::cos(angles.yaw) * wx + std::sin(angles.yaw) * wy;
  angles.roll_rate = along / cosine;
  angles.pitch_rate = std::cos(angles.yaw) * wy - std::sin(angles.yaw) * wx;
  angles.yaw_rate = wz + along * std::tan(angles.pitch);
  return angles;
}

}  // namespace

Owned<OdometryMessage> ToOdometry(std::int64_t stamp_ns, std::string_view body,
                                  const BodyState& state, const BodyVariances& variances) {
  Owned<OdometryMessage> odometry;
  SetHeader(&odometry->header, stamp_ns, kWorldFrame);
  SetText(&odometry->child_frame_id, body);
  const auto& [x, y, z] = state.position_m;
  odometry->pose.pose = {{x, y, z}, ToQuaternion(state.orientation_xyzw)};
  odometry->twist.twist = TwistInBody(state);
  SetDiagonal(odometry->pose.covariance, variances.position, variances.orientation);
  SetDiagonal(odometry->twist.covariance, variances.linear_velocity, variances.angular_velocity);
  return odometry;
}

Owned<TwistMessage> ToTwist(const BodyState& state) {
  Owned<TwistMessage> twist;
  *twist = TwistInBody(state);
  return twist;
}

Owned<JointStateMessage> ToJointState(std::int64_t stamp_ns, std::span<const std::string> bodies,
                                      std::span<const BodyState> states) {
  TCS_CHECK(bodies.size() == states.size());
  Owned<JointStateMessage> joints;
  SetHeader(&joints->header, stamp_ns, kWorldFrame);
  Resize(&joints->name, bodies.size() * kJoints.size());
  Resize(&joints->position, bodies.size() * kJoints.size());
  Resize(&joints->velocity, bodies.size() * kJoints.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto& [x, y, z] = states[i].position_m;
    const auto& [vx, vy, vz] = states[i].linear_velocity_mps;
    const Angles a = ToAngles(states[i]);
    const std::array positions = {x, y, z, a.yaw, a.pitch, a.roll};
    const std::array velocities = {vx, vy, vz, a.yaw_rate, a.pitch_rate, a.roll_rate};
    for (std::size_t j = 0; j < kJoints.size(); ++j, ++at) {
      SetText(&joints->name._buffer[at], bodies[i] + kJoints[j]);
      joints->position._buffer[at] = positions[j];
      joints->velocity._buffer[at] = velocities[j];
    }
  }
  return joints;
}

Owned<JointStateMessage> ToRobotJointState(std::int64_t stamp_ns,
                                           std::span<const std::string> joints,
                                           std::span<const JointState> states) {
  TCS_CHECK(joints.size() == states.size());
  Owned<JointStateMessage> message;
  SetHeader(&message->header, stamp_ns, "");
  Resize(&message->name, joints.size());
  for (auto* list : {&message->position, &message->velocity, &message->effort}) {
    Resize(list, joints.size());
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    SetText(&message->name._buffer[i], joints[i]);
    message->position._buffer[i] = states[i].position;
    message->velocity._buffer[i] = states[i].velocity;
    message->effort._buffer[i] = states[i].effort;
  }
  return message;
}

Owned<ClockMessage> ToClock(std::int64_t stamp_ns) {
  Owned<ClockMessage> clock;
  clock->clock = ToTime(stamp_ns);
  return clock;
}

Owned<ImuMessage> ToImu(std::int64_t stamp_ns, std::string_view body, const BodyState& state,
                        const InertialReading& felt, const BodyVariances& variances) {
  Owned<ImuMessage> imu;
  SetHeader(&imu->header, stamp_ns, body);
  imu->orientation = ToQuaternion(state.orientation_xyzw);
  imu->angular_velocity = ToVector3(felt.angular_rate_radps);
  SetDiagonal(imu->orientation_covariance, variances.orientation);
  SetDiagonal(imu->angular_velocity_covariance, variances.angular_rate);
  if (felt.proper_acceleration_mps2.has_value()) {
    imu->linear_acceleration = ToVector3(*felt.proper_acceleration_mps2);
    SetDiagonal(imu->linear_acceleration_covariance, variances.proper_acceleration);
  } else {
    imu->linear_acceleration_covariance[0] = -1;
  }
  return imu;
}

std::variant<Wrench, MessageError> ToWrench(const WrenchMessage& message) {
  const Wrench wrench{{message.force.x, message.force.y, message.force.z},
                      {message.torque.x, message.torque.y, message.torque.z}};
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(wrench.force_n.begin(), wrench.force_n.end(), is_finite)) {
    return MessageError{"has a force that is not finite"};
  }
  if (!std::all_of(wrench.torque_nm.begin(), wrench.torque_nm.end(), is_finite)) {
    return MessageError{"has a torque that is not finite"};
  }
  return wrench;
}

std::variant<PlanarSpeed, MessageError> ToPlanarSpeed(const TwistMessage& message) {
  const PlanarSpeed speed{message.linear.x, message.angular.z};
  if (!std::isfinite(speed.forward_mps) || !std::isfinite(speed.turn_radps)) {
    return MessageError{"has a velocity that is not finite"};
  }
  return speed;
}

std::variant<std::vector<JointGoal>, MessageError> ToJointGoals(
    const Float64MultiArrayMessage& message, std::size_t joints, JointQuantity quantity) {
  if (message.data._length != joints) {
    return MessageError{"has " + std::to_string(message.data._length) + " numbers for " +
                        std::to_string(joints) + " joints"};
  }
  std::vector<JointGoal> goals(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    const double number = message.data._buffer[i];
    if (!std::isfinite(number)) return MessageError{"has a number that is not finite"};
    goals[i].joint = i;
    goals[i].Of(quantity) = number;
  }
  return goals;
}

namespace {

// Where the joints that a message names are among `joints`; else what is wrong with a name.
std::variant<std::vector<std::size_t>, MessageError> PlacesOf(const dds_sequence_string& names,
                                                              std::span<const std::string> joints) {
  std::vector<std::size_t> places;
  std::vector<char> is_named(joints.size(), 0);
  for (std::size_t i = 0; i < names._length; ++i) {
    const std::string_view name = names._buffer[i];
    const auto found = std::find(joints.begin(), joints.end(), name);
    if (found == joints.end()) {
      constexpr std::size_t kLongestQuote = 40;
      return MessageError{"names '" + std::string(name.substr(0, kLongestQuote)) +
                          "', which the channel does not drive"};
    }
    places.push_back(static_cast<std::size_t>(found - joints.begin()));
    if (std::exchange(is_named[places.back()], 1) != 0) {
      return MessageError{"names '" + std::string(name) + "' twice"};
    }
  }
  return places;
}

}  // namespace

std::variant<JointTrajectory, MessageError> ToJointTrajectory(const JointTrajectoryMessage& message,
                                                              std::span<const std::string> joints,
                                                              VirtualDuration realtime_offset) {
  auto places = PlacesOf(message.joint_names, joints);
  if (auto* error = std::get_if<MessageError>(&places)) return std::move(*error);
  JointTrajectory trajectory;
  trajectory.joints = std::get<0>(std::move(places));
  const auto at = [](std::int64_t seconds, std::uint32_t nanoseconds) {
    return VirtualDuration::Nanoseconds(seconds * 1'000'000'000 + nanoseconds);
  };
  const TimeMessage& stamp = message.header.stamp;
  if (stamp.sec != 0 || stamp.nanosec != 0) {
    trajectory.start = VirtualTime{} + (at(stamp.sec, stamp.nanosec) - realtime_offset);
  }
  const auto list = [](const dds_sequence_double& numbers) {
    return std::vector<double>(numbers._buffer, numbers._buffer + numbers._length);
  };
  for (std::size_t i = 0; i < message.points._length; ++i) {
    const auto& point = message.points._buffer[i];
    trajectory.points.push_back({at(point.time_from_start.sec, point.time_from_start.nanosec),
                                 list(point.positions), list(point.velocities)});
  }
  if (std::string wrong = WhatIsWrongWith(trajectory); !wrong.empty()) return MessageError{wrong};
  return trajectory;
}

std::variant<std::vector<JointGoal>, MessageError> ToJointGoals(
    const JointStateMessage& message, std::span<const std::string> joints) {
  const std::size_t count = message.name._length;
  auto places = PlacesOf(message.name, joints);
  if (auto* error = std::get_if<MessageError>(&places)) return std::move(*error);
  std::vector<JointGoal> goals;
  for (const std::size_t joint : std::get<0>(places)) goals.push_back({joint});
  const std::pair<const dds_sequence_double*, JointQuantity> lists[] = {
      {&message.position, JointQuantity::kPosition},
      {&message.velocity, JointQuantity::kVelocity},
      {&message.effort, JointQuantity::kEffort}};
  for (const auto& [list, quantity] : lists) {
    if (list->_length == 0) continue;
    if (list->_length != count) {
      return MessageError{"has " + std::to_string(count) + " names, but a list of " +
                          std::to_string(list->_length) + " numbers"};
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!std::isfinite(list->_buffer[i])) return MessageError{"has a number that is not finite"};
      goals[i].Of(quantity) = list->_buffer[i];
    }
  }
  return goals;
}

}  // namespace tcs::dds
