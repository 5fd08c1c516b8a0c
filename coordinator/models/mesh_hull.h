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

// The hull of `points`, which are finite; its vertices in the order of the points. The result has
// `most_vertices` at most: where the hull had more, it keeps those that are furthest along as many
// directions, evenly spread. Such a result lies within the hull and near it (for a ball of radius r
// by less than 4 r / most_vertices). Empty if the points span no volume.
Hull MeshHull(const std::vector<std::array<double, 3>>& points, std::size_t most_vertices);

// Points around those of a flat mesh, whose hull is a plate of 1/200 of their extent; none if the
// mesh's points are on a line.
std::vector<std::array<double, 3>> PlateOf(const std::vector<std::array<double, 3>>& points);

}  // namespace tcs
