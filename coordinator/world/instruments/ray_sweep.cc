#include "coordinator/world/instruments/ray_sweep.h"

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

RaySweep::RaySweep(const Mount& mount, std::size_t columns, VirtualDuration sweep,
                   const WorldSpec& world)
    : looks_(LooksOf(sweep)),
      columns_(columns),
      column_s_(columns > 1 ? sweep.seconds() / static_cast<double>(columns - 1) : 0),
      seen_(mount, world) {}

void RaySweep::Look(int number, const Eyes& eyes, const Cast& cast) {
  if (number == 0) {
    seen_.Begin(eyes);
    next_ = 0;
  } else {
    seen_.GoOn(looks_.apart, eyes);
  }
  const bool is_last = number + 1 == looks_.count;
  for (; next_ < columns_; ++next_) {
    if (looks_.count > 1) {
      const double looks_passed = static_cast<double>(next_) * column_s_ / looks_.apart.seconds();
      if (looks_passed > number && !is_last) return;
      if (number > 0) seen_.GoTo(looks_passed - (number - 1));
    }
    cast(next_, seen_);
  }
}

}  // namespace tcs
