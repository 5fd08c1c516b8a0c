// How the joints of models stand, as lines of joints.csv.
#pragma once

#include <string>
#include <vector>

#include "coordinator/trace/csv_file.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

class JointLines {
 public:
  JointLines() = default;
  // Lines of all joints of the world's models that have one coordinate: MODEL/JOINT.
  explicit JointLines(const WorldSpec& world);

  bool empty() const { return joints_.empty(); }
  // Writes a line for each joint, as it is at dynamics.Now().
  void Write(Dynamics& dynamics, CsvFile* file);

 private:
  std::vector<std::string> names_;
  std::vector<int> joints_;
  std::vector<JointState> states_;  // memory of Write
};

inline constexpr std::string_view kJointsCsvHead = "time_s,joint,position,velocity,effort";

}  // namespace tcs
