#include "coordinator/world/joint_lines.h"

#include <fmt/format.h>

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
  // As in bodies.csv.
  char time[32];
  const auto end =
      fmt::format_to_n(time, sizeof time, "{:.9f}", static_cast<double>(dynamics.Now().ns()) * 1e-9)
          .out;
  const std::string_view time_s(time, static_cast<std::size_t>(end - time));
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const JointState& s = states_[i];
    file->Line(time_s, names_[i], s.position, s.velocity, s.effort);
  }
}

}  // namespace tcs
