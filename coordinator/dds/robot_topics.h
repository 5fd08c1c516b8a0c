// The coordinator's own ends of topics, as bytes: the samples that it writes about bodies, and the
// samples that it reads for them. No transport here: the code that carries samples calls these
// functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/dds/ros_messages.h"
#include "coordinator/dds/ros_names.h"

namespace tcs::dds {

// A sensor of a scenario (DdsSensorSpec).
class SensorEncoder {
 public:
  // Every message but JointState tells of one body.
  SensorEncoder(SensorMessage message, std::vector<std::string> bodies,
                const BodyVariances& variances = {});

  // The sample in virtual CLOCK_REALTIME `stamp_ns`. `states` are those of the bodies, in their
  // order, `felt` is what the first of them feels.
  [[nodiscard]] std::vector<std::byte> Encode(std::int64_t stamp_ns,
                                              std::span<const BodyState> states,
                                              const InertialReading& felt) const;

 private:
  SensorMessage message_;
  std::vector<std::string> bodies_;
  BodyVariances variances_;
};

// The JointState of a robot's joints; `joints` and `states` go together.
[[nodiscard]] std::vector<std::byte> EncodeJoints(std::int64_t stamp_ns,
                                                  std::span<const std::string> joints,
                                                  std::span<const JointState> states);

[[nodiscard]] std::vector<std::byte> EncodeClock(std::int64_t stamp_ns);

// `cdr` is whatever a client wrote. The error is the rest of a sentence about the sample.
// kWrench is for bodies, the two after it are for joints: numbers without names are the `quantity`
// of each of `joints`, in their order.
[[nodiscard]] std::variant<Wrench, MessageError> DecodeCommand(CommandMessage message,
                                                               std::span<const std::byte> cdr);
[[nodiscard]] std::variant<std::vector<JointGoal>, MessageError> DecodeJointCommand(
    CommandMessage message, std::span<const std::string> joints, JointQuantity quantity,
    std::span<const std::byte> cdr);

// kTwist is for robots on wheels.
[[nodiscard]] std::variant<PlanarSpeed, MessageError> DecodeSpeed(std::span<const std::byte> cdr);

[[nodiscard]] std::variant<JointTrajectory, MessageError> DecodeTrajectory(
    std::span<const std::string> joints, VirtualDuration realtime_offset,
    std::span<const std::byte> cdr);

}  // namespace tcs::dds
