#include "coordinator/dds/command_messages.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "coordinator/dds/ros_fields.h"

namespace tcs::dds {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

template <class Sequence>
void SetNumbers(Sequence* sequence, const std::vector<double>& numbers) {
  Resize(sequence, numbers.size());
  std::ranges::copy(numbers, sequence->_buffer);
}

}  // namespace

Owned<WrenchMessage> ToMessage(const Wrench& wrench) {
  Owned<WrenchMessage> message;
  message->force = ToVector3(wrench.force_n);
  message->torque = ToVector3(wrench.torque_nm);
  return message;
}

Owned<TwistMessage> ToMessage(const PlanarSpeed& speed) {
  Owned<TwistMessage> message;
  message->linear.x = speed.forward_mps;
  message->angular.z = speed.turn_radps;
  return message;
}

Owned<JointStateMessage> ToMessage(std::int64_t stamp_ns, std::span<const std::string> joints,
                                   std::span<const JointGoal> goals) {
  Owned<JointStateMessage> message;
  SetHeader(&message->header, stamp_ns, "");
  Resize(&message->name, goals.size());
  for (std::size_t i = 0; i < goals.size(); ++i) {
    SetText(&message->name._buffer[i], joints[goals[i].joint]);
  }
  const auto set = [&](auto* list, std::optional<double> JointGoal::*quantity) {
    const auto has = [quantity](const JointGoal& goal) { return (goal.*quantity).has_value(); };
    if (std::ranges::none_of(goals, has)) return;
    Resize(list, goals.size());
    for (std::size_t i = 0; i < goals.size(); ++i) {
      list->_buffer[i] = (goals[i].*quantity).value_or(std::numeric_limits<double>::quiet_NaN());
    }
  };
  set(&message->position, &JointGoal::position);
  set(&message->velocity, &JointGoal::velocity);
  set(&message->effort, &JointGoal::effort);
  return message;
}

Owned<JointTrajectoryMessage> ToMessage(VirtualDuration realtime_offset,
                                        std::span<const std::string> joints,
                                        const JointTrajectory& trajectory) {
  Owned<JointTrajectoryMessage> message;
  SetHeader(&message->header, trajectory.start ? (*trajectory.start + realtime_offset).ns() : 0,
            "");
  Resize(&message->joint_names, trajectory.joints.size());
  for (std::size_t i = 0; i < trajectory.joints.size(); ++i) {
    SetText(&message->joint_names._buffer[i], joints[trajectory.joints[i]]);
  }
  Resize(&message->points, trajectory.points.size());
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    auto& point = message->points._buffer[i];
    SetNumbers(&point.positions, trajectory.points[i].positions);
    SetNumbers(&point.velocities, trajectory.points[i].velocities);
    const std::int64_t at_ns = trajectory.points[i].at.ns();
    point.time_from_start = {static_cast<std::int32_t>(at_ns / kSecond_ns),
                             static_cast<std::uint32_t>(at_ns % kSecond_ns)};
  }
  return message;
}

}  // namespace tcs::dds
