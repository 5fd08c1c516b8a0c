// The firmware that leads joints along trajectories: new setpoints of their servos at a steady
// rate.
//
// What a trajectory begins from is known only when its time has come and no command for an earlier
// one does any more, so nothing is done before ActUntil.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/model/joint_trajectory.h"

namespace tcs {

class TrajectoryFollower {
 public:
  // How joints, as Dynamics numbers them, are at a time; as many states as joints.
  using ReadJoints =
      std::function<void(VirtualTime at, std::span<const int>, std::span<JointState>)>;
  // From `at` on these are the goals of the channel's joints.
  using Lead = std::function<void(VirtualTime at, std::span<const JointGoal>)>;

  TrajectoryFollower(const JointGroup& group, VirtualDuration period)
      : group_(group), period_(period) {}

  // The trajectory came at `sent`. It replaces what is going on when it starts, and what was to
  // start later.
  void Follow(VirtualTime sent, const JointTrajectory& trajectory);

  VirtualTime NextStop() const;
  void ActUntil(VirtualTime until, const ReadJoints& read, const Lead& lead);

 private:
  struct Path {
    VirtualTime start;   // that its points count from
    VirtualTime begins;  // not before it came
    JointTrajectory trajectory;
    std::vector<double> from{};  // where its joints are when it begins
  };
  void Begin(Path path, const ReadJoints& read);

  JointGroup group_;
  VirtualDuration period_;
  std::deque<Path> waiting_;  // in the order in which they begin
  std::optional<Path> path_;  // that is being followed
  VirtualTime next_ = VirtualTime::Never();
};

}  // namespace tcs
