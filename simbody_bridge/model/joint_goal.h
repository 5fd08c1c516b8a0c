// A program's goal for a joint, and the drive that the goal becomes.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "simbody_bridge/dynamics.h"

namespace tcs {

enum class JointQuantity { kPosition, kVelocity, kEffort };
inline constexpr std::array<std::string_view, 3> kJointQuantities = {"position", "velocity",
                                                                     "effort"};

// rad, rad/s and N m, or m, m/s and N; finite. A quantity that is not wanted is not there.
struct JointGoal {
  std::size_t joint = 0;  // among the joints that the program drives
  std::optional<double> position{}, velocity{}, effort{};

  std::optional<double>& Of(JointQuantity quantity) {
    switch (quantity) {
      case JointQuantity::kPosition:
        return position;
      case JointQuantity::kVelocity:
        return velocity;
      case JointQuantity::kEffort:
        break;
    }
    return effort;
  }
  bool operator==(const JointGoal&) const = default;
};

struct JointGains {
  double stiffness = 0;  // N m / rad or N / m: of the error in position
  double damping = 0;    // N m s / rad or N s / m: of the error in velocity

  bool operator==(const JointGains&) const = default;
};

// A servo for a position or a velocity, and the effort beside it. A goal with a position and no
// velocity means to stand there.
inline JointDrive ToDrive(const JointGoal& goal, const JointGains& gains) {
  JointDrive drive;
  drive.effort = goal.effort.value_or(0);
  if (goal.position) {
    drive.stiffness = gains.stiffness;
    drive.position = *goal.position;
  }
  if (goal.position || goal.velocity) {
    drive.damping = gains.damping;
    drive.velocity = goal.velocity.value_or(0);
  }
  return drive;
}

}  // namespace tcs
