#include "coordinator/world/trajectory_follower.h"

#include <algorithm>
#include <utility>

namespace tcs {

void TrajectoryFollower::Follow(VirtualTime sent, const JointTrajectory& trajectory) {
  const VirtualTime start = trajectory.start.value_or(sent), begins = std::max(start, sent);
  while (!waiting_.empty() && waiting_.back().begins >= begins) waiting_.pop_back();
  waiting_.push_back({start, begins, trajectory});
}

VirtualTime TrajectoryFollower::NextStop() const {
  return waiting_.empty() ? next_ : std::min(next_, waiting_.front().begins);
}

void TrajectoryFollower::Begin(Path path, const ReadJoints& read) {
  std::vector<int> joints;
  for (const std::size_t joint : path.trajectory.joints) joints.push_back(group_.joints[joint]);
  std::vector<JointState> states(joints.size());
  read(path.begins, joints, states);
  for (const JointState& state : states) path.from.push_back(state.position);
  next_ = path.begins;
  path_ = std::move(path);
}

void TrajectoryFollower::ActUntil(VirtualTime until, const ReadJoints& read, const Lead& lead) {
  for (VirtualTime at = NextStop(); at <= until && !at.IsNever(); at = NextStop()) {
    if (!waiting_.empty() && waiting_.front().begins == at) {
      Path path = std::move(waiting_.front());
      waiting_.pop_front();
      Begin(std::move(path), read);
    }
    const JointTrajectory& trajectory = path_->trajectory;
    std::vector<JointGoal> goals;
    for (std::size_t i = 0; i < trajectory.joints.size(); ++i) {
      const JointSetpoint wanted = SetpointAt(trajectory, i, path_->from[i], at - path_->start);
      JointGoal& goal = goals.emplace_back(JointGoal{trajectory.joints[i]});
      goal.position = wanted.position;
      goal.velocity = wanted.velocity;
    }
    lead(at, goals);
    const VirtualTime end = path_->start + trajectory.length();
    next_ = at >= end ? VirtualTime::Never() : std::min(at + period_, end);
  }
}

}  // namespace tcs
