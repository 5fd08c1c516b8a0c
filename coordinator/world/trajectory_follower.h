// The firmware that leads joints along trajectories: new setpoints of their servos at a steady
// rate.
//
// The positions that a trajectory begins from are known only when its time has come and no command
// for an earlier time comes any more, so nothing is done before ActUntil.
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
  // Reads the states of joints, as Dynamics numbers them, at a time; as many states as joints.
  using ReadJoints =
      std::function<void(VirtualTime at, std::span<const int>, std::span<JointState>)>;
  // From `at` on these are the goals of the channel's joints.
  using Lead = std::function<void(VirtualTime at, std::span<const JointGoal>)>;

  TrajectoryFollower(const JointGroup& group, VirtualDuration period)
      : group_(group), period_(period) {}

  // The trajectory came at `sent`. It replaces the trajectory that is going on when it starts, and
  // trajectories that were to start later.
  void Follow(VirtualTime sent, const JointTrajectory& trajectory);

  VirtualTime NextStop() const;
  void ActUntil(VirtualTime until, const ReadJoints& read, const Lead& lead);

 private:
  struct Path {
    VirtualTime start;   // the points' times count from it
    VirtualTime begins;  // not before the trajectory came
    JointTrajectory trajectory;
    std::vector<double> from{};  // where the joints are when it begins
  };
  void Begin(Path path, const ReadJoints& read);

  JointGroup group_;
  VirtualDuration period_;
  std::deque<Path> waiting_;  // in the order of their beginnings
  std::optional<Path> path_;  // the path being followed
  VirtualTime next_ = VirtualTime::Never();
};

}  // namespace tcs
