#include "coordinator/world/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace tcs {
namespace {

// The first thing of a joint's goal that the joint cannot do.
struct Beyond {
  std::string asked, given;
};

// Cuts the goal to what the joint can do.
std::optional<Beyond> Cut(const JointLimits& limits, JointGoal* goal) {
  std::optional<Beyond> beyond;
  const auto cut = [&](std::optional<double>* value, double least, double most, const char* what) {
    if (!value->has_value()) return;
    const double given = std::clamp(**value, least, most);
    if (given == **value) return;
    if (!beyond) beyond = {fmt::format("{} {:.6g}", what, **value), fmt::format("{:.6g}", given)};
    *value = given;
  };
  cut(&goal->position, limits.lower, limits.upper, "the position");
  cut(&goal->velocity, -limits.velocity, limits.velocity, "the velocity");
  cut(&goal->effort, -limits.effort, limits.effort, "the effort");
  return beyond;
}

}  // namespace

void Commands::Open(const std::vector<CommandChannelSpec>& specs, std::vector<std::string> bodies) {
  for (const CommandChannelSpec& spec : specs) {
    Channel& channel = channels_.emplace_back(Channel{.spec = spec});
    const auto add = [&](const std::string& kind, const std::vector<std::string>& names,
                         const std::string& model) {
      for (const std::string& name : names) {
        channel.accounts.push_back(
            account_.Add(fmt::format("{} '{}' of {}", kind, name, model), spec.name));
        channel.targets.push_back(model + "/" + name);
      }
    };
    if (spec.joints) {
      const JointGroup& group = spec.joints->group;
      add("joint", group.names, group.model);
      channel.goal_names = group.names;
      channel.goal_names.insert(channel.goal_names.end(), group.followers.begin(),
                                group.followers.end());
    }
    if (spec.rotors) add("rotor", spec.rotors->names, spec.rotors->model);
    if (spec.joints && spec.joints->setpoint_period) {
      channel.follower.emplace(spec.joints->group, *spec.joints->setpoint_period);
    }
    if (spec.link) channel.targets = {spec.link->name};
    const auto body = static_cast<std::size_t>(spec.body);
    if (!spec.IsOfModel() && body < bodies.size()) channel.targets = {bodies[body]};
  }
}

void Commands::Take(std::size_t channel, const CommandSent& sent, const Wrench& wrench) {
  Channel& on = channels_[channel];
  ++on.taken;
  ++taken_;
  Wrench limited = wrench;
  for (std::size_t i = 0; i < 3; ++i) {
    const double force = on.spec.most_force_n[i], torque = on.spec.most_torque_nm[i];
    limited.force_n[i] = std::clamp(wrench.force_n[i], -force, force);
    limited.torque_nm[i] = std::clamp(wrench.torque_nm[i], -torque, torque);
  }
  Log(on, sent.at, limited);
  if (on.spec.link) {
    const auto frame = on.spec.in_body_frame ? WrenchFrame::kLink : WrenchFrame::kWorld;
    push_(sent.at, on.spec.latency, on.spec.link->link, frame, limited);
    return;
  }
  limited.in_body_frame = on.spec.in_body_frame;
  limited.lag = on.spec.lag;
  act_(sent.at, on.spec.latency, on.spec.body, limited);
}

void Commands::Log(const Channel& on, VirtualTime sent, const Wrench& wrench) {
  static constexpr std::array<std::string_view, 3> kForce = {"force_x", "force_y", "force_z"},
                                                   kTorque = {"torque_x", "torque_y", "torque_z"};
  if (on.targets.empty()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    log_.Write({sent, on.spec.latency}, on.spec.name, on.targets[0], kForce[i], wrench.force_n[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    log_.Write({sent, on.spec.latency}, on.spec.name, on.targets[0], kTorque[i],
               wrench.torque_nm[i]);
  }
}

void Commands::Take(std::size_t channel, const CommandSent& sent,
                    std::span<const JointGoal> goals) {
  Channel& on = channels_[channel];
  if (on.spec.rotors) {
    for (const JointGoal& goal : goals) {
      if (goal.velocity && !goal.position && !goal.effort) continue;
      Refuse(channel, "a command sets something other than a speed for rotor '" +
                          on.spec.rotors->names[goal.joint] + "'");
      return;
    }
  }
  ++on.taken;
  ++taken_;
  for (const JointGoal& goal : goals) {
    if (on.spec.joints && goal.joint >= on.spec.joints->group.joints.size()) {
      LeaveFollowerOut(&on, goal);
      continue;
    }
    account_.Take(on.accounts[goal.joint], sent.at + on.spec.latency, sent.by);
    if (on.spec.rotors) {
      SpinRotor(on, sent.at, goal);
    } else {
      DriveJoint(on, sent.at, goal);
    }
  }
}

void Commands::LeaveFollowerOut(Channel* on, const JointGoal& goal) {
  if (std::exchange(on->has_named_follower, true)) return;
  warn_(
      fmt::format("channel {}: commands name joint '{}', which follows another one and is driven "
                  "by that alone: what they say of it is left out",
                  on->spec.name, on->goal_names[goal.joint]));
}

void Commands::DriveJoint(const Channel& on, VirtualTime sent, JointGoal goal) {
  const JointDriveSpec& joints = *on.spec.joints;
  if (const auto beyond = Cut(joints.limits[goal.joint], &goal)) {
    account_.TakeBeyond(on.accounts[goal.joint], sent + on.spec.latency, beyond->asked,
                        beyond->given);
  }
  for (std::size_t i = 0; i < kJointQuantities.size(); ++i) {
    const std::optional<double>& value = goal.Of(static_cast<JointQuantity>(i));
    if (!value) continue;
    log_.Write({sent, on.spec.latency}, on.spec.name, on.targets[goal.joint], kJointQuantities[i],
               *value);
  }
  drive_(sent, on.spec.latency, joints.group.joints[goal.joint],
         ToDrive(goal, joints.gains[goal.joint]));
}

void Commands::SpinRotor(const Channel& on, VirtualTime sent, const JointGoal& goal) {
  const RotorDriveSpec& rotors = *on.spec.rotors;
  const double most_radps = rotors.most_radps[goal.joint];
  const double asked = *goal.velocity, most = rotors.is_normalised ? 1 : most_radps;
  const double given = std::clamp(asked, 0.0, most);
  if (given != asked) {
    account_.TakeBeyond(on.accounts[goal.joint], sent + on.spec.latency,
                        fmt::format("the speed {:.6g}", asked), fmt::format("{:.6g}", given));
  }
  const double speed_radps = rotors.is_normalised ? given * most_radps : given;
  log_.Write({sent, on.spec.latency}, on.spec.name, on.targets[goal.joint], "speed", speed_radps);
  spin_(sent, on.spec.latency, rotors.rotors[goal.joint], speed_radps);
}

void Commands::Take(std::size_t channel, const CommandSent& sent,
                    const JointTrajectory& trajectory) {
  Channel& on = channels_[channel];
  ++on.taken;
  ++taken_;
  JointTrajectory driven = trajectory;
  for (std::size_t i = driven.joints.size(); i-- > 0;) {
    if (driven.joints[i] < on.spec.joints->group.joints.size()) continue;
    LeaveFollowerOut(&on, {driven.joints[i]});
    LeaveOut(i, &driven);
  }
  if (!driven.joints.empty()) on.follower->Follow(sent.at, driven);
}

void Commands::Take(std::size_t channel, const CommandSent& sent, const PlanarSpeed& speed) {
  Channel& on = channels_[channel];
  ++on.taken;
  ++taken_;
  if (on.halts < sent.at) Halt(&on);
  Turn(on, sent.at, speed);
  const VirtualDuration timeout = on.spec.joints->wheels->timeout;
  if (timeout > VirtualDuration{}) on.halts = sent.at + timeout;
}

// Makes all wheels turn so that the robot goes as `speed` says.
void Commands::Turn(const Channel& channel, VirtualTime sent, const PlanarSpeed& speed) {
  const JointDriveSpec& joints = *channel.spec.joints;
  const WheelDriveSpec& wheels = *joints.wheels;
  const WheelSpeeds speeds = Limited(WheelSpeedsOf(wheels.base, speed), wheels.most_radps);
  const CommandLog::Moment moment{sent, channel.spec.latency};
  log_.Write(moment, channel.spec.name, joints.group.model, "forward", speed.forward_mps);
  log_.Write(moment, channel.spec.name, joints.group.model, "turn", speed.turn_radps);
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
  for (const Channel& channel : channels_) {
    next = std::min(next, channel.halts);
    if (channel.follower) next = std::min(next, channel.follower->NextStop());
  }
  return next;
}

void Commands::ActUntil(VirtualTime until) {
  for (Channel& channel : channels_) {
    if (channel.halts <= until && !channel.halts.IsNever()) Halt(&channel);
    if (!channel.follower) continue;
    channel.follower->ActUntil(until, read_, [&](VirtualTime at, std::span<const JointGoal> goals) {
      for (const JointGoal& goal : goals) {
        account_.Take(channel.accounts[goal.joint], at + channel.spec.latency);
        DriveJoint(channel, at, goal);
      }
    });
  }
}

std::optional<GoalNames> Commands::GoalsOf(std::size_t channel) const {
  const CommandChannelSpec& spec = channels_[channel].spec;
  if (spec.joints) {
    return GoalNames{channels_[channel].goal_names, spec.joints->quantity,
                     spec.joints->wheels.has_value(), spec.joints->setpoint_period.has_value(),
                     spec.joints->group.followers.size()};
  }
  if (spec.rotors) return GoalNames{spec.rotors->names, JointQuantity::kVelocity};
  return {};
}

void Commands::Refuse(std::size_t channel, const std::string& why) {
  Channel& on = channels_[channel];
  if (++on.refused == 1) warn_("channel " + on.spec.name + ": " + why);
}

std::string Commands::ComplaintAbout(std::size_t channel, const Inlet::Place& place,
                                     const std::string& body) const {
  const Channel& on = channels_[channel];
  if (on.taken + on.refused == 0) {
    return fmt::format("channel {}: nothing came in {}, so no command moved {}; let a client {}",
                       on.spec.name, place.where, body, place.mend);
  }
  if (on.refused <= 1) return {};
  return fmt::format("channel {}: {} of the {} messages that came in were no commands",
                     on.spec.name, on.refused, on.taken + on.refused);
}

}  // namespace tcs
