// The sensors of robots that are models, as a scenario describes them: plain values, already
// checked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "shm/virtual_time.h"
#include "simbody_bridge/geodesy.h"
#include "simbody_bridge/model/pose.h"
#include "simbody_bridge/model/wheel_base.h"

namespace tcs {

// Where a sensor sits.
struct Mount {
  int link = 0;  // as Dynamics numbers them
  Pose at;       // in the link's frame
  std::string frame;
};

struct ImuSpec {
  Mount mount;
};

// Where the mount is in the world, and how it moves: the truth, as far as the sensor's noise leaves
// it.
struct TruthSpec {
  Mount mount;
  std::string world_frame = "world";
};

// The odometry that a robot's firmware makes of how far its wheels have turned.
struct WheelOdometrySpec {
  std::vector<int> joints;  // as Dynamics numbers them
  std::size_t left = 1;     // so many wheels are on the left; they come first
  WheelBase base;
  std::string frame = "odom", child_frame = "base_link";
};

// Where links are in the frames of their parents.
struct TransformsSpec {
  struct Pair {
    int parent = -1;  // -1: the world
    int child = 0;
    std::string parent_frame, child_frame;
  };
  std::vector<Pair> pairs;
};

// The places of links that do not move, told once.
struct FixedTransformsSpec {
  TransformsSpec transforms;
};

// The robot's own file, told once.
struct DescriptionSpec {
  std::string text;
};

// How far rays go, and what is told of it.
struct ReachSpec {
  double least_m = 0.1, most_m = 30;
};

// A scanner that turns about its z axis.
struct LidarSpec {
  Mount mount;
  std::size_t rays = 360;
  double first_rad = -std::numbers::pi, last_rad = std::numbers::pi;
  ReachSpec reach;
  VirtualDuration sweep{};  // from the first ray to the last
};

// A lidar with several rays above each other.
struct Lidar3dSpec {
  LidarSpec lidar;
  std::size_t layers = 16;
  double lowest_rad = -0.2617993877991494, highest_rad = 0.2617993877991494;
};

// The distance to the nearest thing in a cone.
struct RangeSpec {
  Mount mount;
  double field_of_view_rad = 0.26;
  ReachSpec reach{.least_m = 0.02, .most_m = 4};
  bool is_infrared = false;
};

// A pinhole camera that sees distances.
struct DepthCameraSpec {
  Mount mount;
  std::size_t width = 64, height = 48;
  double field_of_view_rad = 1.0472;  // from the left edge to the right one
  ReachSpec reach{.least_m = 0.1, .most_m = 10};
};

// The world's x axis points east, its y axis north.
struct GnssSpec {
  Mount mount;
  Geodetic origin;  // of the world
};

struct MagnetometerSpec {
  Mount mount;
  std::array<double, 3> field_t{0, 2e-5, -4.4e-5};  // in the world
};

// In the standard atmosphere.
struct BarometerSpec {
  Mount mount;
  double ground_pa = 101'325;  // where z is 0 in the world
};

// Whether the link touches anything that is not of its own robot.
struct ContactSpec {
  Mount mount;
  double margin_m = 1e-3;  // a thing as near as this is touched
};

using InstrumentSpec =
    std::variant<ImuSpec, TruthSpec, WheelOdometrySpec, TransformsSpec, FixedTransformsSpec,
                 DescriptionSpec, LidarSpec, Lidar3dSpec, RangeSpec, DepthCameraSpec, GnssSpec,
                 MagnetometerSpec, BarometerSpec, ContactSpec>;

// The fields of a measurement that can have errors.
enum class MeasuredField {
  kOrientation,
  kAngularRate,
  kProperAcceleration,
  kPosition,
  kLinearVelocity,
  kAngularVelocity,
  kRange,
  kMagneticField,
  kPressure,
  kCount
};
inline constexpr std::size_t kMeasuredFields = static_cast<std::size_t>(MeasuredField::kCount);

}  // namespace tcs
