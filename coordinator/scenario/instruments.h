// The sensors of robots that are models, as a scenario describes them: plain values, already
// checked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <variant>

#include "shm/virtual_time.h"
#include "simbody_bridge/model/pose.h"

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

// Where the mount is in the world, and how it moves: the truth, as far as its noise leaves it.
struct TruthSpec {
  Mount mount;
  std::string world_frame = "world";
};

// A scanner that turns about its z axis.
struct LidarSpec {
  Mount mount;
  std::size_t rays = 360;
  double first_rad = -std::numbers::pi, last_rad = std::numbers::pi;
  double least_m = 0.1, most_m = 30;
  VirtualDuration sweep{};  // from the first ray to the last
};

using InstrumentSpec = std::variant<ImuSpec, TruthSpec, LidarSpec>;

// What can be wrong of a measurement.
enum class MeasuredField {
  kOrientation,
  kAngularRate,
  kProperAcceleration,
  kPosition,
  kLinearVelocity,
  kAngularVelocity,
  kRange,
  kCount
};
inline constexpr std::size_t kMeasuredFields = static_cast<std::size_t>(MeasuredField::kCount);

}  // namespace tcs
