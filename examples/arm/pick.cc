#include "examples/arm/pick.h"

#include <algorithm>
#include <cmath>

#include "examples/arm/cell.h"
#include "examples/arm/collisions.h"
#include "examples/arm/timing.h"

namespace arm {
namespace {

constexpr double kAlongS = 0.16, kUpS = 0.5, kAboveM = 0.1;

// From 0 at rest to a steady speed of 1, without a jump of the acceleration, in the time 1: the
// half of it far.
double Faster(double share) { return share * share * share * (1 - share / 2); }

// Of the tool, `t` after the beginning.
Vector3d ToolAt(const Part& part, double at_s, double t) {
  const double touch_y = part.YAt(at_s), leave_s = kDownS + kAlongS;
  const double v = part.belt_mps;
  if (t < kDownS) {
    const double share = t / kDownS;
    return {part.x_m, touch_y + v * kDownS * (Faster(share) - 0.5),
            kPartTop + kAboveM * (1 - Eased(share))};
  }
  if (t < leave_s) return {part.x_m, touch_y + v * (t - kDownS), kPartTop};
  const double share = (t - leave_s) / kUpS;
  return {part.x_m, touch_y + v * (kAlongS + kUpS * (0.5 - Faster(1 - share))),
          kPartTop + kAboveM * Eased(share)};
}

}  // namespace

std::optional<Points> Pick(const Part& part, double at_s, double near_rad) {
  const double whole_s = kDownS + kAlongS + kUpS;
  const auto count = static_cast<int>(std::ceil(whole_s / kPointS));
  const auto stand = [&](double t) {
    return ToolDownAt(ToolAt(part, at_s, t), part.yaw_rad, near_rad);
  };
  Points points;
  for (int i = 0; i <= count; ++i) {
    const double t = whole_s * i / count;
    constexpr double kStepS = 1e-3;  // for the velocity
    const auto before = stand(std::max(t - kStepS, 0.0));
    const auto here = stand(t);
    const auto after = stand(std::min(t + kStepS, whole_s));
    if (!before || !here || !after || !IsFree(*here)) return std::nullopt;
    const bool is_end = i == 0 || i == count;
    points.push_back(
        {t, *here, is_end ? Joints::Zero() : Joints((*after - *before) / (2 * kStepS))});
    near_rad = (*here)[5];
  }
  return points;
}

}  // namespace arm
