// The commands of a run: which commands come in on their channels, and when they act. Keeps account
// of them, for the sentences about channels where nothing came in, or nothing of use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/world/actuator_account.h"
#include "coordinator/world/command_log.h"
#include "coordinator/world/trajectory_follower.h"

namespace tcs {

class Commands final : public CommandSink {
 public:
  // From `sent` plus `latency` on the wrench acts on the body.
  using Act =
      std::function<void(VirtualTime sent, VirtualDuration latency, int body, const Wrench&)>;

  // The same, for a joint, a rotor or a link, as Dynamics numbers them.
  using Drive =
      std::function<void(VirtualTime sent, VirtualDuration latency, int joint, const JointDrive&)>;
  using Spin =
      std::function<void(VirtualTime sent, VirtualDuration latency, int rotor, double speed_radps)>;
  using Push = std::function<void(VirtualTime sent, VirtualDuration latency, int link, WrenchFrame,
                                  const Wrench&)>;

  // `warn` is told of the first thing on each channel that was no command. Firmware that follows
  // trajectories asks `read`.
  Commands(std::function<void(const std::string&)> warn, Act act, Drive drive = {}, Spin spin = {},
           Push push = {}, TrajectoryFollower::ReadJoints read = {})
      : warn_(std::move(warn)),
        act_(std::move(act)),
        drive_(std::move(drive)),
        spin_(std::move(spin)),
        push_(std::move(push)),
        read_(std::move(read)) {}

  // The scenario's channels; before anything comes in. `bodies` are the names of the world's
  // bodies.
  void Open(const std::vector<CommandChannelSpec>& specs, std::vector<std::string> bodies = {});
  // Commands that are given to the physics are written there, too.
  CommandLog& log() { return log_; }

  void Take(std::size_t channel, const CommandSent& sent, const Wrench& wrench) override;
  void Take(std::size_t channel, const CommandSent& sent,
            std::span<const JointGoal> goals) override;
  void Take(std::size_t channel, const CommandSent& sent, const PlanarSpeed& speed) override;
  void Take(std::size_t channel, const CommandSent& sent,
            const JointTrajectory& trajectory) override;
  std::optional<GoalNames> GoalsOf(std::size_t channel) const override;
  void Refuse(std::size_t channel, const std::string& why) override;
  void Note(const std::string& sentence) override { warn_(sentence); }

  // The time at which firmware does something by itself next.
  VirtualTime NextStop() const;
  // Firmware does what is due by `until`, each thing at its own time. No command for an earlier
  // time comes any more.
  void ActUntil(VirtualTime until);

  // The number of commands that acted, on all channels.
  std::int64_t taken() const { return taken_; }

  // At the end of the run: a sentence about the channel. Empty where messages came in and at most
  // one was no command: `warn` was told of that one at once.
  std::string ComplaintAbout(std::size_t channel, const Inlet::Place& place,
                             const std::string& body) const;
  // The same, for the joints and rotors of all channels.
  std::vector<std::string> ComplaintsAboutActuators() const { return account_.Complaints(); }

 private:
  struct Channel {
    CommandChannelSpec spec;
    std::vector<std::size_t> accounts{};  // of each joint or rotor
    std::vector<std::string> targets{};   // likewise, or of what is pushed
    std::vector<std::string>
        goal_names{};                 // of the joints that it drives, then of those that follow
    bool has_named_follower = false;  // and `warn` was told
    std::int64_t taken = 0, refused = 0;
    VirtualTime halts = VirtualTime::Never();  // unless a command comes before
    std::optional<TrajectoryFollower> follower{};
  };
  void LeaveFollowerOut(Channel* on, const JointGoal& goal);
  void DriveJoint(const Channel& on, VirtualTime sent, JointGoal goal);
  void SpinRotor(const Channel& on, VirtualTime sent, const JointGoal& goal);
  void Halt(Channel* channel);
  void Turn(const Channel& channel, VirtualTime sent, const PlanarSpeed& speed);
  void Log(const Channel& on, VirtualTime sent, const Wrench& wrench);

  std::function<void(const std::string&)> warn_;
  Act act_;
  Drive drive_;
  Spin spin_;
  Push push_;
  TrajectoryFollower::ReadJoints read_;
  ActuatorAccount account_;
  CommandLog log_;
  std::vector<Channel> channels_;  // as in the scenario
  std::int64_t taken_ = 0;
};

}  // namespace tcs
