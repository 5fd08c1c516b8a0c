#include "coordinator/dds/robot_topics.h"

#include <utility>

namespace tcs::dds {

SensorEncoder::SensorEncoder(SensorMessage message, std::vector<std::string> bodies,
                             const BodyVariances& variances)
    : message_(message), bodies_(std::move(bodies)), variances_(variances) {
  TCS_CHECK(bodies_.size() == 1 || message_ == SensorMessage::kJointState);
}

std::vector<std::byte> SensorEncoder::Encode(std::int64_t stamp_ns,
                                             std::span<const BodyState> states,
                                             const InertialReading& felt) const {
  TCS_CHECK(states.size() == bodies_.size());
  switch (message_) {
    case SensorMessage::kOdometry:
      return ToCdr(ToOdometry(stamp_ns, bodies_[0], states[0], variances_));
    case SensorMessage::kImu:
      return ToCdr(ToImu(stamp_ns, bodies_[0], states[0], felt, variances_));
    case SensorMessage::kJointState:
      return ToCdr(ToJointState(stamp_ns, bodies_, states));
    case SensorMessage::kTwist:
      return ToCdr(ToTwist(states[0]));
    default:  // of robots' own sensors
      break;
  }
  TCS_CHECK(false);
  return {};
}

std::vector<std::byte> EncodeJoints(std::int64_t stamp_ns, std::span<const std::string> joints,
                                    std::span<const JointState> states) {
  return ToCdr(ToRobotJointState(stamp_ns, joints, states));
}

std::vector<std::byte> EncodeClock(std::int64_t stamp_ns) { return ToCdr(ToClock(stamp_ns)); }

std::variant<Wrench, MessageError> DecodeCommand(CommandMessage message,
                                                 std::span<const std::byte> cdr) {
  TCS_CHECK(message == CommandMessage::kWrench);
  const auto wrench = FromCdr<WrenchMessage>(cdr);
  if (const auto* error = std::get_if<CdrError>(&wrench)) return MessageError{error->message};
  return ToWrench(*std::get<Owned<WrenchMessage>>(wrench));
}

std::variant<std::vector<JointGoal>, MessageError> DecodeJointCommand(
    CommandMessage message, std::span<const std::string> joints, JointQuantity quantity,
    std::span<const std::byte> cdr) {
  if (message == CommandMessage::kFloat64MultiArray) {
    const auto numbers = FromCdr<Float64MultiArrayMessage>(cdr);
    if (const auto* error = std::get_if<CdrError>(&numbers)) return MessageError{error->message};
    return ToJointGoals(*std::get<Owned<Float64MultiArrayMessage>>(numbers), joints.size(),
                        quantity);
  }
  TCS_CHECK(message == CommandMessage::kJointState);
  const auto states = FromCdr<JointStateMessage>(cdr);
  if (const auto* error = std::get_if<CdrError>(&states)) return MessageError{error->message};
  return ToJointGoals(*std::get<Owned<JointStateMessage>>(states), joints);
}

std::variant<PlanarSpeed, MessageError> DecodeSpeed(std::span<const std::byte> cdr) {
  const auto twist = FromCdr<TwistMessage>(cdr);
  if (const auto* error = std::get_if<CdrError>(&twist)) return MessageError{error->message};
  return ToPlanarSpeed(*std::get<Owned<TwistMessage>>(twist));
}

std::variant<JointTrajectory, MessageError> DecodeTrajectory(std::span<const std::string> joints,
                                                             VirtualDuration realtime_offset,
                                                             std::span<const std::byte> cdr) {
  const auto message = FromCdr<JointTrajectoryMessage>(cdr);
  if (const auto* error = std::get_if<CdrError>(&message)) return MessageError{error->message};
  return ToJointTrajectory(*std::get<Owned<JointTrajectoryMessage>>(message), joints,
                           realtime_offset);
}

}  // namespace tcs::dds
