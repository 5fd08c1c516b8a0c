// The convex hull of points. Pure.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace tcs {

struct ConvexHull {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<int, 3>> triangles;  // counterclockwise as seen from outside
};

// Whether HullOf finds a hull. Takes time in the number of points.
bool SpansVolume(std::span<const std::array<double, 3>> points);

// None: the points lie in a plane, within a millionth of their extent. Points that are as near to
// the hull of the others may be left out. `points` are finite. Takes time in the number of points
// times that of the hull's triangles.
std::optional<ConvexHull> HullOf(std::span<const std::array<double, 3>> points);

}  // namespace tcs
