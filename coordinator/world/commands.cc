#include "coordinator/world/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tcs {

void Commands::Open(const std::vector<CommandChannelSpec>& specs) {
  for (const CommandChannelSpec& spec : specs) channels_.push_back({spec});
}

void Commands::Take(std::size_t channel, VirtualTime sent, const Wrench& wrench) {
  Channel& on = channels_[channel];
  ++on.taken;
  ++taken_;
  Wrench limited = wrench;
  limited.in_body_frame = on.spec.in_body_frame;
  limited.lag = on.spec.lag;
  for (std::size_t i = 0; i < 3; ++i) {
    const double force = on.spec.most_force_n[i], torque = on.spec.most_torque_nm[i];
    limited.force_n[i] = std::clamp(wrench.force_n[i], -force, force);
    limited.torque_nm[i] = std::clamp(wrench.torque_nm[i], -torque, torque);
  }
  act_(sent, on.spec.latency, on.spec.body, limited);
}

void Commands::Take(std::size_t channel, VirtualTime sent, std::span<const JointGoal> goals) {
  Channel& on = channels_[channel];
  ++on.taken;
  ++taken_;
  for (const JointGoal& goal : goals) {
    drive_(sent, on.spec.latency, on.spec.joints->group.joints[goal.joint],
           ToDrive(goal, on.spec.joints->gains[goal.joint]));
  }
}

void Commands::Take(std::size_t channel, VirtualTime sent, const PlanarSpeed& speed) {
  Channel& on = channels_[channel];
  ++on.taken;
  ++taken_;
  if (on.halts < sent) Halt(&on);
  Turn(on, sent, speed);
  const VirtualDuration timeout = on.spec.joints->wheels->timeout;
  if (timeout > VirtualDuration{}) on.halts = sent + timeout;
}

// Makes all wheels turn as the robot is to go.
void Commands::Turn(const Channel& channel, VirtualTime sent, const PlanarSpeed& speed) {
  const JointDriveSpec& joints = *channel.spec.joints;
  const WheelDriveSpec& wheels = *joints.wheels;
  const WheelSpeeds speeds = Limited(WheelSpeedsOf(wheels.base, speed), wheels.most_radps);
  for (std::size_t i = 0; i < joints.group.joints.size(); ++i) {
    JointGoal goal{i};
    goal.velocity = i < wheels.left ? speeds.left_radps : speeds.right_radps;
    drive_(sent, channel.spec.latency, joints.group.joints[i], ToDrive(goal, joints.gains[i]));
  }
}

void Commands::Halt(Channel* channel) {
  Turn(*channel, std::exchange(channel->halts, VirtualTime::Never()), {});
}

VirtualTime Commands::NextStop() const {
  VirtualTime next = VirtualTime::Never();
  for (const Channel& channel : channels_) next = std::min(next, channel.halts);
  return next;
}

void Commands::ActUntil(VirtualTime until) {
  for (Channel& channel : channels_) {
    if (channel.halts <= until && !channel.halts.IsNever()) Halt(&channel);
  }
}

const JointDriveSpec* Commands::JointsOf(std::size_t channel) const {
  const CommandChannelSpec& spec = channels_[channel].spec;
  return spec.joints ? &*spec.joints : nullptr;
}

void Commands::Refuse(std::size_t channel, const std::string& why) {
  Channel& on = channels_[channel];
  if (++on.refused == 1) warn_("channel " + on.spec.name + ": " + why);
}

std::string Commands::ComplaintAbout(std::size_t channel, const Inlet::Place& place,
                                     const std::string& body) const {
  const Channel& on = channels_[channel];
  if (on.taken + on.refused == 0) {
    return fmt::format(
        "channel {}: nothing came in {}, so that no command moved {}; let a client "
        "{}",
        on.spec.name, place.where, body, place.mend);
  }
  if (on.refused <= 1) return {};
  return fmt::format("channel {}: {} of the {} messages that came in were no commands",
                     on.spec.name, on.refused, on.taken + on.refused);
}

}  // namespace tcs
