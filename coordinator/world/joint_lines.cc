#include "coordinator/world/joint_lines.h"

#include "coordinator/world/csv_row.h"

namespace tcs {

JointLines::JointLines(const WorldSpec& world) {
  int number = 0;
  for (const RobotModel& model : world.models) {
    for (const Joint& joint : model.joints) {
      if (CoordinatesOf(joint.kind) == 1) {
        names_.push_back(model.name + "/" + joint.name);
        joints_.push_back(number);
      }
      ++number;
    }
  }
  states_.resize(joints_.size());
}

void JointLines::Write(Dynamics& dynamics, CsvFile* file) {
  if (joints_.empty()) return;
  dynamics.ReadJoints(dynamics.Now(), joints_, states_);
  const CsvTime time_s(dynamics.Now());
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const JointState& s = states_[i];
    file->Line(time_s.text(), names_[i], s.position, s.velocity, s.effort);
  }
}

}  // namespace tcs
