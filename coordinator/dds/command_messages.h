// Programs' commands that came in another form, as ROS 2 messages, for recordings.
//
// Units as in ros_messages.h. A value that a command leaves open is NaN.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "coordinator/dds/ros_types.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/model/joint_goal.h"
#include "simbody_bridge/model/joint_trajectory.h"
#include "simbody_bridge/model/wheel_base.h"

namespace tcs::dds {

[[nodiscard]] Owned<WrenchMessage> ToMessage(const Wrench& wrench);
[[nodiscard]] Owned<TwistMessage> ToMessage(const PlanarSpeed& speed);
// The goals count joints by their places in `joints`. A quantity that no goal has is an empty list.
[[nodiscard]] Owned<JointStateMessage> ToMessage(std::int64_t stamp_ns,
                                                 std::span<const std::string> joints,
                                                 std::span<const JointGoal> goals);
// The stamp in the message's header is the trajectory's start; 0: the message's arrival. Stamps are
// `realtime_offset` ahead of virtual time.
[[nodiscard]] Owned<JointTrajectoryMessage> ToMessage(VirtualDuration realtime_offset,
                                                      std::span<const std::string> joints,
                                                      const JointTrajectory& trajectory);

}  // namespace tcs::dds
