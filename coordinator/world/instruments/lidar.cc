#include "coordinator/world/instruments/lidar.h"

#include <cmath>
#include <limits>

namespace tcs {
namespace {

// Between two looks links move as their velocities say; a wheel that turns at 100 rad/s goes half a
// radian in this time.
constexpr VirtualDuration kLooksApart = VirtualDuration::Milliseconds(5);

Instrument::Looks LooksOf(VirtualDuration sweep) {
  if (sweep == VirtualDuration{}) return {};
  const std::int64_t parts = (sweep.ns() + kLooksApart.ns() - 1) / kLooksApart.ns();
  // Rounded down: the last look is not after the next sweep's first.
  return {static_cast<int>(parts) + 1, VirtualDuration::Nanoseconds(sweep.ns() / parts)};
}

}  // namespace

double WithinReach(double distance_m, double least_m, double most_m) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (distance_m > most_m) return kInfinity;
  return distance_m < least_m ? -kInfinity : distance_m;
}

Lidar::Lidar(const LidarSpec& spec, VirtualDuration period, const WorldSpec& world)
    : spec_(spec), looks_(LooksOf(spec.sweep)), seen_(spec.mount, world) {
  const auto gaps = static_cast<double>(spec.rays > 1 ? spec.rays - 1 : 1);
  measured_.frame = spec.mount.frame;
  measured_.first_rad = spec.first_rad;
  measured_.step_rad = spec.rays > 1 ? (spec.last_rad - spec.first_rad) / gaps : 0;
  measured_.ray_s = spec.rays > 1 ? spec.sweep.seconds() / gaps : 0;
  measured_.scan_s = period.seconds();
  measured_.least_m = spec.least_m;
  measured_.most_m = spec.most_m;
  measured_.ranges_m.resize(spec.rays);
}

void Lidar::Look(int number, VirtualTime, const Eyes& eyes) {
  if (number == 0) {
    seen_.Begin(eyes);
    cast_ = 0;
  } else {
    seen_.GoOn(looks_.apart, eyes);
  }
  CastUpTo(number);
}

// All rays up to that look.
void Lidar::CastUpTo(int look) {
  const bool is_last = look + 1 == looks_.count;
  for (; cast_ < spec_.rays; ++cast_) {
    const auto ray = static_cast<double>(cast_);
    if (looks_.count > 1) {
      const double looks_passed = ray * measured_.ray_s / looks_.apart.seconds();
      if (looks_passed > look && !is_last) return;
      if (look > 0) seen_.GoTo(looks_passed - (look - 1));
    }
    const double angle = spec_.first_rad + ray * measured_.step_rad;
    measured_.ranges_m[cast_] =
        WithinReach(seen_.Cast({std::cos(angle), std::sin(angle), 0}), spec_.least_m, spec_.most_m);
  }
}

}  // namespace tcs
