// The messages between a robot's programs and their body, as JSON: one object each time
// (docs/SCENARIO.md). No transport here: UDP and others carry the messages.
//
// Units and frames as in simbody_bridge/dynamics.h: SI, world frame, quaternions x y z w. Pure
// functions: equal input gives equal bytes, whatever the locale.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/scenario/scenario.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

// {"time":1.23,"frame_id":"world","bodies":{"NAME":{"position":[x,y,z],"orientation":[x,y,z,w],
// "linear_velocity":[x,y,z],"angular_velocity":[x,y,z]}}} for these fields: bodies and fields in
// the order given, time in seconds, no line end. Every double reads back as the same double; a
// proper acceleration that is not known yet is null.
[[nodiscard]] std::string EncodeReading(const Reading& reading,
                                        std::span<const SensorField> fields);

// The text that EncodeReading makes of a reading of joints:
// {"time":1.23,"joints":{"NAME":{"position":q,"velocity":v,"effort":e}}}, in the same way.
[[nodiscard]] std::string EncodeJoints(const Reading& reading);

struct DecodeError {
  std::string message;  // the rest of a sentence that begins with what was decoded; quotes little
};

// {"force":[x,y,z],"torque":[x,y,z]}; either key may be left out and is zero then. The text may be
// anything that a program sent: any other text, and numbers that are not finite, are an error.
[[nodiscard]] std::variant<Wrench, DecodeError> DecodeCommand(std::string_view text);

// {"NAME":1.5} or {"NAME":{"position":q,"velocity":v,"effort":e}} for any of `joints`: a number by
// itself is the joint's `quantity`. Any other text is an error, as for DecodeCommand.
[[nodiscard]] std::variant<std::vector<JointGoal>, DecodeError> DecodeJointCommand(
    std::string_view text, std::span<const std::string> joints, JointQuantity quantity);

// {"linear":[x,y,z],"angular":[x,y,z]}, of which x and z are taken; either key may be left out and
// is zero then. Any other text is an error, as for DecodeCommand.
[[nodiscard]] std::variant<PlanarSpeed, DecodeError> DecodeSpeed(std::string_view text);

// {"joints":["NAME"],"points":[{"positions":[q],"velocities":[v],"time_from_start":1.0}]} for any
// of `joints`, in seconds; velocities may be left out. With "start", a virtual time in seconds, the
// trajectory starts then. Any other text is an error, as for DecodeCommand.
[[nodiscard]] std::variant<JointTrajectory, DecodeError> DecodeTrajectory(
    std::string_view text, std::span<const std::string> joints);

// Gives the channel's command `text` to `sink`, or refuses it; `what` says what the text is, and
// begins the sentence.
void TakeCommand(std::string_view what, std::string_view text, std::size_t channel,
                 const CommandSent& sent, CommandSink& sink);

}  // namespace tcs
