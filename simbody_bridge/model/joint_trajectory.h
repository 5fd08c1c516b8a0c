// Where joints are to be, and when.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shm/virtual_time.h"

namespace tcs {

struct JointTrajectory {
  struct Point {
    VirtualDuration at;              // after the start
    std::vector<double> positions;   // of each joint
    std::vector<double> velocities;  // likewise, or none
  };
  std::vector<std::size_t> joints;   // among those that a program drives, each once
  std::vector<Point> points;         // at least one, later ones after earlier ones
  std::optional<VirtualTime> start;  // none: when it comes

  VirtualDuration length() const { return points.back().at; }
};

// The mistake in the trajectory, as the rest of a sentence about it; empty: none.
std::string WhatIsWrongWith(const JointTrajectory& trajectory);

// Makes `trajectory` one of the other joints alone. `number` counts joints as `joints` does.
void LeaveOut(std::size_t number, JointTrajectory* trajectory);

struct JointSetpoint {
  double position = 0, velocity = 0;
};

// Where the trajectory's joint of that number is to be `after` its start, if it was at `from` then.
// Between two points with velocities the path is a cubic through both (the start has the velocity
// 0), else a straight line. From the last point on the joint is to stay there.
JointSetpoint SetpointAt(const JointTrajectory& trajectory, std::size_t joint, double from,
                         VirtualDuration after);

}  // namespace tcs
