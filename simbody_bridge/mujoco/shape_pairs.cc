#include "simbody_bridge/mujoco/shape_pairs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tcs {
namespace {

constexpr std::size_t kMostPairs = 64;
// Beyond what rounding may do.
constexpr double kClearanceM = 1e-3;

// Planes have no bounding ball, and for boxes the ball says little: a floor may be a box.
bool IsFlat(const mjModel& model, int geom) {
  return model.geom_type[geom] == mjGEOM_PLANE || model.geom_type[geom] == mjGEOM_BOX;
}

// So the flatter one of two comes first.
bool IsFlatter(const mjModel& model, int one, int other) {
  const auto rank = [&](int geom) {
    return std::tuple(model.geom_type[geom] == mjGEOM_PLANE, IsFlat(model, geom),
                      model.geom_rbound[geom]);
  };
  return rank(one) > rank(other);
}

// How far a point is from a geom, at least; negative within a plane's half of the world.
double DistanceTo(const mjModel& model, const mjData& data, int geom, const double* point) {
  const double* center = data.geom_xpos + 3 * geom;
  const double away[3] = {point[0] - center[0], point[1] - center[1], point[2] - center[2]};
  if (!IsFlat(model, geom)) {
    return std::sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]) -
           model.geom_rbound[geom];
  }
  const double* axes = data.geom_xmat + 9 * geom;  // in columns
  const auto along = [&](int axis) {
    return axes[axis] * away[0] + axes[3 + axis] * away[1] + axes[6 + axis] * away[2];
  };
  if (model.geom_type[geom] == mjGEOM_PLANE) return along(2);
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double out = std::abs(along(axis)) - model.geom_size[3 * geom + axis];
    if (out > 0) square += out * out;
  }
  return std::sqrt(square);
}

}  // namespace

ShapePairs::ShapePairs(const Forest& forest, std::span<const std::size_t> shapes,
                       const mjModel& model) {
  const int count = static_cast<int>(shapes.size());
  const auto shape_of = [&](int geom) -> const ForestShape& {
    return forest.shapes[shapes[static_cast<std::size_t>(geom)]];
  };
  // The middle of a cylinder is in it.
  const auto is_middle = [&](int geom) {
    return geom > 0 && &shape_of(geom) == &shape_of(geom - 1);
  };
  for (int one = 0; one < count; ++one) {
    if (is_middle(one)) continue;
    for (int other = 0; other < one; ++other) {
      if (is_middle(other)) continue;
      if (!MayTouch(forest, shape_of(one), shape_of(other))) continue;
      are_too_many_ = pairs_.size() == kMostPairs;
      if (are_too_many_) return;
      pairs_.push_back(IsFlatter(model, one, other) ? std::pair(one, other)
                                                    : std::pair(other, one));
    }
  }
}

bool ShapePairs::AreApart(const mjModel& model, const mjData& data) const {
  return !are_too_many_ && std::ranges::all_of(pairs_, [&](const std::pair<int, int>& pair) {
    const auto [flat, round] = pair;
    const double clear_m = model.geom_rbound[round] + kClearanceM;
    return DistanceTo(model, data, flat, data.geom_xpos + 3 * round) > clear_m;
  });
}

}  // namespace tcs
