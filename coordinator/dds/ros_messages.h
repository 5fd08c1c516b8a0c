// What a body does, as ROS 2 messages, and what it is told.
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

#include "coordinator/dds/ros_types.h"
#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"

namespace tcs::dds {

struct MessageError {
  std::string message;  // what is wrong with a sample, as the rest of a sentence about it
};

[[nodiscard]] TimeMessage ToTime(std::int64_t stamp_ns);

// The pose in the world's frame, the twist in the body's, as Odometry has it. What the simulation
// says is exact: the covariances are zero.
[[nodiscard]] Owned<OdometryMessage> ToOdometry(std::int64_t stamp_ns, std::string_view body,
                                                const BodyState& state);

// The velocities in the body's frame.
[[nodiscard]] Owned<TwistMessage> ToTwist(const BodyState& state);

// Free bodies have no joints but the six that hang them in the world: each body is a chain of
// BODY/x, BODY/y, BODY/z (m, m/s) and BODY/yaw, BODY/pitch, BODY/roll (rad and rad/s; rotations
// about the fixed axes x, y, z in this order, as REP-103 has them). With the nose straight up or
// down roll and yaw are one rotation: it counts as yaw. Efforts are not known, so their list is
// empty. `bodies` and `states` go together.
[[nodiscard]] Owned<JointStateMessage> ToJointState(std::int64_t stamp_ns,
                                                    std::span<const std::string> bodies,
                                                    std::span<const BodyState> states);

[[nodiscard]] Owned<ClockMessage> ToClock(std::int64_t stamp_ns);

// An accelerometer and a gyroscope at a body's centre of mass, their axes the body's.
class InertialSensor {
 public:
  InertialSensor(std::string body, const std::array<double, 3>& gravity_mps2)
      : body_(std::move(body)), gravity_mps2_(gravity_mps2) {}

  // The sample at `at`, later than the one before. As accelerometers do, it tells the specific
  // force (acceleration less gravity: none in free fall), meant over the time since the sample
  // before. The first sample has none, and says so as Imu does: by a covariance that begins with
  // -1.
  [[nodiscard]] Owned<ImuMessage> Sample(VirtualTime at, std::int64_t stamp_ns,
                                         const BodyState& state);

 private:
  std::string body_;
  std::array<double, 3> gravity_mps2_;
  bool has_before_ = false;
  VirtualTime before_at_{};
  std::array<double, 3> before_velocity_mps_{};
};

// Force and torque in the world's frame, the force at the centre of mass, as with UDP. Refused
// where they are not finite.
[[nodiscard]] std::variant<Wrench, MessageError> ToWrench(const WrenchMessage& message);

}  // namespace tcs::dds
