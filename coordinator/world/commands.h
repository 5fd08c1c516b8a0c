// The commands of a run: what comes in on their channels, and when it acts. Keeps account of it,
// for the sentences about channels where nothing came in, or nothing of use.
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

  // The same of a joint, a rotor or a link, as Dynamics numbers them.
  using Drive =
      std::function<void(VirtualTime sent, VirtualDuration latency, int joint, const JointDrive&)>;
  using Spin =
      std::function<void(VirtualTime sent, VirtualDuration latency, int rotor, double speed_radps)>;
  using Push = std::function<void(VirtualTime sent, VirtualDuration latency, int link, WrenchFrame,
                                  const Wrench&)>;

  // `warn` is told of the first thing on each channel that was no command. `read` is asked by
  // firmware that follows trajectories.
  Commands(std::function<void(const std::string&)> warn, Act act, Drive drive = {}, Spin spin = {},
           Push push = {}, TrajectoryFollower::ReadJoints read = {})
      : warn_(std::move(warn)),
        act_(std::move(act)),
        drive_(std::move(drive)),
        spin_(std::move(spin)),
        push_(std::move(push)),
        read_(std::move(read)) {}

  // The scenario's channels; before anything comes in. `bodies` are what the bodies of the world
  // are called.
  void Open(const std::vector<CommandChannelSpec>& specs, std::vector<std::string> bodies = {});
  // What is given to the physics is written there, too.
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

  // When firmware does something by itself next.
  VirtualTime NextStop() const;
  // It does what is due by `until`, at its own times. No command for an earlier time comes any
  // more.
  void ActUntil(VirtualTime until);

  // Of all channels, what acted.
  std::int64_t taken() const { return taken_; }

  // At the end of the run: what there is to say about the channel. Empty where commands came in and
  // no more was none than what was said at once.
  std::string ComplaintAbout(std::size_t channel, const Inlet::Place& place,
                             const std::string& body) const;
  // The same about the joints and rotors of all channels.
  std::vector<std::string> ComplaintsAboutActuators() const { return account_.Complaints(); }

 private:
  struct Channel {
    CommandChannelSpec spec;
    std::vector<std::size_t> accounts{};  // of each joint or rotor
    std::vector<std::string> targets{};   // likewise, or of what is pushed
    std::vector<std::string>
        goal_names{};                 // of the joints that it drives, then of those that follow
    bool has_named_follower = false;  // which has been said
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
