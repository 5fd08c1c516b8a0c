#include "coordinator/models/decimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace tcs {
namespace {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

// One vertex for each value of `key_of`, in the middle of the vertices that have it.
template <class KeyOf>
Surface Clustered(const Surface& surface, const KeyOf& key_of) {
  std::map<decltype(key_of(Point{})), std::uint32_t> number_of;
  std::vector<std::uint32_t> cluster_of;
  std::vector<double> counts;
  Surface clustered;
  for (const Point& vertex : surface.vertices) {
    const auto number = static_cast<std::uint32_t>(clustered.vertices.size());
    const auto [known, is_new] = number_of.try_emplace(key_of(vertex), number);
    if (is_new) {
      clustered.vertices.push_back({});
      counts.push_back(0);
    }
    cluster_of.push_back(known->second);
    counts[known->second] += 1;
    for (std::size_t i = 0; i < 3; ++i) clustered.vertices[known->second][i] += vertex[i];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    for (double& x : clustered.vertices[i]) x /= counts[i];
  }
  // Each triangle once, whichever of its corners it begins with.
  std::set<Triangle> seen;
  for (const Triangle& triangle : surface.triangles) {
    Triangle now;
    for (std::size_t i = 0; i < 3; ++i) now[i] = cluster_of[triangle[i]];
    if (now[0] == now[1] || now[1] == now[2] || now[2] == now[0]) continue;
    std::rotate(now.begin(), std::min_element(now.begin(), now.end()), now.end());
    if (seen.insert(now).second) clustered.triangles.push_back(now);
  }
  return clustered;
}

// The surface with only the vertices that a triangle has.
Surface WithoutLoose(const Surface& surface) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number_of(surface.vertices.size(), kNone);
  Surface kept;
  for (Triangle triangle : surface.triangles) {
    for (std::uint32_t& vertex : triangle) {
      std::uint32_t& number = number_of[vertex];
      if (number == kNone) {
        number = static_cast<std::uint32_t>(kept.vertices.size());
        kept.vertices.push_back(surface.vertices[vertex]);
      }
      vertex = number;
    }
    kept.triangles.push_back(triangle);
  }
  return kept;
}

}  // namespace

Surface Decimated(const Surface& surface, std::size_t most_triangles) {
  Surface best = Clustered(surface, [](const Point& vertex) { return vertex; });
  if (best.triangles.size() <= most_triangles) return WithoutLoose(best);
  const Surface whole = best;
  Point least = whole.vertices.front(), most = least;
  for (const Point& vertex : whole.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      least[i] = std::min(least[i], vertex[i]);
      most[i] = std::max(most[i], vertex[i]);
    }
  }
  const double longest =
      std::max({most[0] - least[0], most[1] - least[1], most[2] - least[2], 1e-300});
  constexpr double kFinest = 1024, kCoarser = 0.8;
  for (double cells = kFinest; best.triangles.size() > most_triangles; cells *= kCoarser) {
    best = Clustered(whole, [&](const Point& vertex) {
      const auto cell = [&](std::size_t i) {
        return static_cast<int>(std::floor((vertex[i] - least[i]) / longest * cells));
      };
      return std::tuple(cell(0), cell(1), cell(2));
    });
  }
  return WithoutLoose(best);
}

}  // namespace tcs
