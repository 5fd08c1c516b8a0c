#include "coordinator/world/instruments/snapshots.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coordinator/world/instruments/lidar.h"

namespace tcs {
namespace {

// Around the middle, as densely everywhere; the last ring is the cone's edge.
constexpr int kRings = 3, kRaysInARing = 6;

}  // namespace

RangeFinder::RangeFinder(const RangeSpec& spec, const WorldSpec& world)
    : spec_(spec), seen_(spec.mount, world), directions_{{1, 0, 0}} {
  for (int ring = 1; ring <= kRings; ++ring) {
    const double off = spec.field_of_view_rad / 2 * ring / kRings;
    for (int i = 0; i < ring * kRaysInARing; ++i) {
      const double around = 2 * std::numbers::pi * i / (ring * kRaysInARing);
      directions_.push_back(
          {std::cos(off), std::sin(off) * std::cos(around), std::sin(off) * std::sin(around)});
    }
  }
  measured_.frame = spec.mount.frame;
  measured_.is_infrared = spec.is_infrared;
  measured_.field_of_view_rad = spec.field_of_view_rad;
  measured_.least_m = spec.reach.least_m;
  measured_.most_m = spec.reach.most_m;
}

void RangeFinder::Look(int, VirtualTime, const Eyes& eyes) {
  seen_.Begin(eyes);
  double nearest = kMeetsNothing;
  for (const auto& direction : directions_) nearest = std::min(nearest, seen_.Cast(direction));
  measured_.range_m = WithinReach(nearest, spec_.reach);
}

DepthCamera::DepthCamera(const DepthCameraSpec& spec, const WorldSpec& world)
    : spec_(spec), seen_(spec.mount, world) {
  measured_.frame = spec.mount.frame;
  measured_.width = spec.width;
  measured_.height = spec.height;
  measured_.depths_m.resize(spec.width * spec.height);
}

void DepthCamera::Look(int, VirtualTime, const Eyes& eyes) {
  seen_.Begin(eyes);
  const auto width = static_cast<double>(spec_.width), height = static_cast<double>(spec_.height);
  const double pixel = 2 * std::tan(spec_.field_of_view_rad / 2) / width;  // at 1 m
  std::size_t at = 0;
  for (std::size_t row = 0; row < spec_.height; ++row) {
    for (std::size_t column = 0; column < spec_.width; ++column, ++at) {
      const double left = pixel * (width / 2 - 0.5 - static_cast<double>(column));
      const double up = pixel * (height / 2 - 0.5 - static_cast<double>(row));
      const double length = std::sqrt(1 + left * left + up * up);
      const double range_m = seen_.Cast({1 / length, left / length, up / length});
      measured_.depths_m[at] = WithinReach(range_m / length, spec_.reach);
    }
  }
}

}  // namespace tcs
