// The measurements of robots' sensors, as values: each transport makes its messages of them.
//
// SI units. Frames are named as the scenario names them; a mounted sensor looks along the x axis of
// its frame, with z up, as REP-103 has bodies. A distance beyond a sensor's reach is infinity, and
// a distance before it is minus infinity (REP-117).
//
// A variance is that of each axis, in the unit squared, and no axis depends on another one; 0 where
// no error is known. The error of an orientation is a turn about its axes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "simbody_bridge/geodesy.h"
#include "simbody_bridge/inertial.h"
#include "simbody_bridge/model/pose.h"

namespace tcs {

struct ImuMeasurement {
  std::string frame;
  std::array<double, 4> orientation_xyzw{0, 0, 0, 1};  // in the world
  InertialReading felt;                                // along the axes of the frame
  double orientation_variance = 0, rate_variance = 0, acceleration_variance = 0;
};

// Where `child_frame` is in `frame`, and how it moves there, along its own axes.
struct OdometryMeasurement {
  std::string frame, child_frame;
  Pose pose;
  std::array<double, 3> linear_mps{}, angular_radps{};
  double position_variance = 0, orientation_variance = 0;
  double linear_variance = 0, angular_variance = 0;
};

struct TransformsMeasurement {
  struct Transform {
    std::string frame, child_frame;
    Pose pose;
  };
  std::vector<Transform> transforms;
};

struct DescriptionMeasurement {
  std::string text;
};

// Rays side by side, the first of them at the time of the measurement.
struct ScanMeasurement {
  std::string frame;
  double first_rad = 0, step_rad = 0;  // about z
  double ray_s = 0, scan_s = 0;        // between two rays, between two scans
  double least_m = 0, most_m = 0;
  std::vector<double> ranges_m;
};

// The points that rays in several layers have met, each seen from where the sensor was then.
struct CloudMeasurement {
  struct Point {
    std::array<double, 3> direction{};  // of unit length
    double range_m = 0;
    double after_s = 0;       // the first ray
    std::uint16_t layer = 0;  // from below
  };
  std::string frame;
  std::vector<Point> points;
};

struct RangeMeasurement {
  std::string frame;
  bool is_infrared = false;  // else ultrasound
  double field_of_view_rad = 0;
  double least_m = 0, most_m = 0;
  double range_m = 0;
  double range_variance = 0;
};

// The distance ahead, along x, to what each pixel sees; rows from above, from the left.
struct DepthMeasurement {
  std::string frame;
  std::size_t width = 0, height = 0;
  std::vector<double> depths_m;
};

struct GnssMeasurement {
  std::string frame;
  Geodetic origin;                // of the world
  std::array<double, 3> enu_m{};  // from `origin`, along the world's axes
  double position_variance = 0;
  Geodetic position() const { return ToGeodetic(origin, enu_m); }
};

struct MagneticMeasurement {
  std::string frame;
  std::array<double, 3> field_t{};  // along the axes of the frame
  double field_variance = 0;
};

struct PressureMeasurement {
  std::string frame;
  double pressure_pa = 0;
  double pressure_variance = 0;
};

struct ContactMeasurement {
  std::string frame;
  bool is_touching = false;
};

// Empty: not of such a sensor.
using Measurement =
    std::variant<std::monostate, ImuMeasurement, OdometryMeasurement, TransformsMeasurement,
                 DescriptionMeasurement, ScanMeasurement, CloudMeasurement, RangeMeasurement,
                 DepthMeasurement, GnssMeasurement, MagneticMeasurement, PressureMeasurement,
                 ContactMeasurement>;

}  // namespace tcs
