// The motion of bodies and the commands to them, as ROS 2 messages.
//
// SI units and REP-103's axes, as in simbody_bridge/dynamics.h. Stamps are virtual CLOCK_REALTIME
// in nanoseconds since 1970; a message holds seconds in 32 bits, as ROS 2 does, so until 2038. The
// world's frame is "world", a body's frame is called after the body.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "coordinator/dds/ros_types.h"
#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/inertial.h"
#include "simbody_bridge/model/joint_goal.h"
#include "simbody_bridge/model/joint_trajectory.h"
#include "simbody_bridge/model/wheel_base.h"

namespace tcs::dds {

struct MessageError {
  std::string message;  // the fault in a sample, as the rest of a sentence about it
};

// The variances of the values that a message has of a body, on each axis, none of which depends on
// another one; in the unit squared. 0: no error is known, which ROS 2 takes for unknown.
struct BodyVariances {
  double position = 0, orientation = 0, linear_velocity = 0, angular_velocity = 0;
  double angular_rate = 0, proper_acceleration = 0;
};

// The pose in the world's frame, the twist in the body's, as Odometry has it.
[[nodiscard]] Owned<OdometryMessage> ToOdometry(std::int64_t stamp_ns, std::string_view body,
                                                const BodyState& state,
                                                const BodyVariances& variances = {});

// The velocities in the body's frame.
[[nodiscard]] Owned<TwistMessage> ToTwist(const BodyState& state);

// Free bodies have no joints but the six that hang them in the world: a body is a chain of BODY/x,
// BODY/y, BODY/z (m, m/s) and BODY/yaw, BODY/pitch, BODY/roll (rad and rad/s; rotations about the
// fixed axes x, y, z in this order, as REP-103 has them). With the nose straight up or down roll
// and yaw are one rotation, which counts as yaw. Efforts are not known, so their list is empty.
// `bodies` and `states` go together.
[[nodiscard]] Owned<JointStateMessage> ToJointState(std::int64_t stamp_ns,
                                                    std::span<const std::string> bodies,
                                                    std::span<const BodyState> states);

// The joints of a robot, with the effort that their drives give. `joints` and `states` go together.
[[nodiscard]] Owned<JointStateMessage> ToRobotJointState(std::int64_t stamp_ns,
                                                         std::span<const std::string> joints,
                                                         std::span<const JointState> states);

[[nodiscard]] Owned<ClockMessage> ToClock(std::int64_t stamp_ns);

// The motion that a body feels, in the frame that is called after the body. Where there is no
// acceleration yet the message says so as Imu does: by a covariance that begins with -1.
[[nodiscard]] Owned<ImuMessage> ToImu(std::int64_t stamp_ns, std::string_view body,
                                      const BodyState& state, const InertialReading& felt,
                                      const BodyVariances& variances = {});

// Force and torque in the world's frame, the force at the centre of mass, as with UDP. Values that
// are not finite are refused.
[[nodiscard]] std::variant<Wrench, MessageError> ToWrench(const WrenchMessage& message);

// How fast a robot on wheels is to go: along x and about z. Such a robot can do nothing else, so
// the other components mean nothing.
[[nodiscard]] std::variant<PlanarSpeed, MessageError> ToPlanarSpeed(const TwistMessage& message);

// A number for each of `joints` joints, in their order, as the forward controllers of ros2_control
// have it. `quantity` says which quantity of the joint is wanted.
[[nodiscard]] std::variant<std::vector<JointGoal>, MessageError> ToJointGoals(
    const Float64MultiArrayMessage& message, std::size_t joints, JointQuantity quantity);

// For any of `joints`, by name; lists of positions, velocities and efforts may be empty.
[[nodiscard]] std::variant<std::vector<JointGoal>, MessageError> ToJointGoals(
    const JointStateMessage& message, std::span<const std::string> joints);

// For any of `joints`, by name. A stamp of 0 means that the trajectory starts when it comes, as ROS
// 2 has it; any other stamp is `realtime_offset` ahead of virtual time. Accelerations and efforts
// mean nothing here.
[[nodiscard]] std::variant<JointTrajectory, MessageError> ToJointTrajectory(
    const JointTrajectoryMessage& message, std::span<const std::string> joints,
    VirtualDuration realtime_offset);

}  // namespace tcs::dds
