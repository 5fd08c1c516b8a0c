#include "coordinator/world/instruments/lidar.h"

#include <cmath>
#include <limits>

namespace tcs {
namespace {

double StepOf(double first, double last, std::size_t count) {
  return count > 1 ? (last - first) / static_cast<double>(count - 1) : 0;
}

}  // namespace

double WithinReach(double distance_m, const ReachSpec& reach) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (distance_m > reach.most_m) return kInfinity;
  return distance_m < reach.least_m ? -kInfinity : distance_m;
}

Lidar::Lidar(const LidarSpec& spec, VirtualDuration period, const WorldSpec& world)
    : spec_(spec), sweep_(spec.mount, spec.rays, spec.sweep, world) {
  measured_.frame = spec.mount.frame;
  measured_.first_rad = spec.first_rad;
  measured_.step_rad = StepOf(spec.first_rad, spec.last_rad, spec.rays);
  measured_.ray_s = sweep_.column_s();
  measured_.scan_s = period.seconds();
  measured_.least_m = spec.reach.least_m;
  measured_.most_m = spec.reach.most_m;
  measured_.ranges_m.resize(spec.rays);
}

void Lidar::Look(int number, VirtualTime, const Eyes& eyes) {
  sweep_.Look(number, eyes, [this](std::size_t ray, const Seen& seen) {
    const double angle = spec_.first_rad + static_cast<double>(ray) * measured_.step_rad;
    measured_.ranges_m[ray] =
        WithinReach(seen.Cast({std::cos(angle), std::sin(angle), 0}), spec_.reach);
  });
}

Lidar3d::Lidar3d(const Lidar3dSpec& spec, const WorldSpec& world)
    : spec_(spec), sweep_(spec.lidar.mount, spec.lidar.rays, spec.lidar.sweep, world) {
  measured_.frame = spec.lidar.mount.frame;
}

void Lidar3d::Look(int number, VirtualTime, const Eyes& eyes) {
  const LidarSpec& lidar = spec_.lidar;
  const double step_rad = StepOf(lidar.first_rad, lidar.last_rad, lidar.rays);
  const double rise_rad = StepOf(spec_.lowest_rad, spec_.highest_rad, spec_.layers);
  if (number == 0) measured_.points.clear();
  sweep_.Look(number, eyes, [&](std::size_t column, const Seen& seen) {
    const auto place = static_cast<double>(column);
    const double angle = lidar.first_rad + place * step_rad;
    for (std::size_t layer = 0; layer < spec_.layers; ++layer) {
      const double rise = spec_.lowest_rad + static_cast<double>(layer) * rise_rad;
      const std::array<double, 3> direction = {std::cos(rise) * std::cos(angle),
                                               std::cos(rise) * std::sin(angle), std::sin(rise)};
      const double range_m = WithinReach(seen.Cast(direction), lidar.reach);
      if (!std::isfinite(range_m)) continue;
      measured_.points.push_back(
          {direction, range_m, place * sweep_.column_s(), static_cast<std::uint16_t>(layer)});
    }
  });
}

}  // namespace tcs
