// What programs command, as ROS 2 messages: of commands that came in another form, for recordings.
//
// Units as in ros_messages.h. What a command leaves open is NaN.
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
// `joints` are those that goals count. A quantity that no goal has is an empty list.
[[nodiscard]] Owned<JointStateMessage> ToMessage(std::int64_t stamp_ns,
                                                 std::span<const std::string> joints,
                                                 std::span<const JointGoal> goals);
// Its header's stamp is the start; 0: when it comes. `realtime_offset` is what stamps are ahead of
// virtual time.
[[nodiscard]] Owned<JointTrajectoryMessage> ToMessage(VirtualDuration realtime_offset,
                                                      std::span<const std::string> joints,
                                                      const JointTrajectory& trajectory);

}  // namespace tcs::dds
