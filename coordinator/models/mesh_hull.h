// The convex hull of points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tcs {

struct Hull {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counterclockwise as seen from outside
};

// The hull of `points`, which are finite; its vertices in the order of the points. It has
// `most_vertices` at most: where there were more, those that are furthest along as many directions,
// evenly spread, which lies within the hull and near it (for a ball of radius r by less than
// 4 r / most_vertices). Empty if the points span no volume.
Hull MeshHull(const std::vector<std::array<double, 3>>& points, std::size_t most_vertices);

}  // namespace tcs
