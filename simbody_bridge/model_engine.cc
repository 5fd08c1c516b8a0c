#include "simbody_bridge/model_engine.h"

#include <algorithm>

namespace tcs {

double EffortOf(const JointDrive& drive, double limit, double position, double velocity) {
  const double effort = drive.effort + drive.stiffness * (drive.position - position) +
                        drive.damping * (drive.velocity - velocity);
  return std::clamp(effort, -limit, limit);
}

}  // namespace tcs
