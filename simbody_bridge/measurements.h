// What sensors of robots measure, as values: each transport makes its messages of them.
//
// SI units. Frames are named as the scenario names them; a mounted sensor looks along the x axis of
// its frame, with z up, as REP-103 has bodies.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "simbody_bridge/inertial.h"
#include "simbody_bridge/model/pose.h"

namespace tcs {

struct ImuMeasurement {
  std::string frame;
  std::array<double, 4> orientation_xyzw{0, 0, 0, 1};  // in the world
  InertialReading felt;                                // along the axes of the frame
};

// Where `child_frame` is in `frame`, and how it moves there, along its own axes.
struct OdometryMeasurement {
  std::string frame, child_frame;
  Pose pose;
  std::array<double, 3> linear_mps{}, angular_radps{};
};

// Rays side by side, the first of them at the time of the measurement.
struct ScanMeasurement {
  std::string frame;
  double first_rad = 0, step_rad = 0;  // about z
  double ray_s = 0, scan_s = 0;        // between two rays, between two scans
  double least_m = 0, most_m = 0;
  // What is farther than the most is at infinity, and what is nearer than the least at minus
  // infinity (REP-117).
  std::vector<double> ranges_m;
};

// Empty: not of such a sensor.
using Measurement =
    std::variant<std::monostate, ImuMeasurement, OdometryMeasurement, ScanMeasurement>;

}  // namespace tcs
