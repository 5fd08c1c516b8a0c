#include "coordinator/models/mesh_hull.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <set>

#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// Triangles of indices into `points`, turned either way.
std::vector<Triangle> Facets(const std::vector<Point>& points) {
  std::vector<Triangle> triangles;
  const std::unique_ptr<std::FILE, CloseFile> nowhere(std::fopen("/dev/null", "we"));
  if (nowhere == nullptr) return triangles;
  qhT memory;
  qhT* const qh = &memory;
  qh_zero(qh, nowhere.get());
  std::vector<coordT> coordinates;
  coordinates.reserve(3 * points.size());
  for (const Point& point : points)
    coordinates.insert(coordinates.end(), point.begin(), point.end());
  char options[] = "qhull Qt";  // facets as triangles
  if (qh_new_qhull(qh, 3, static_cast<int>(points.size()), coordinates.data(), False, options,
                   nowhere.get(), nowhere.get()) == 0) {
    facetT* facet;
    FORALLfacets {
      Triangle triangle{};
      std::size_t count = 0;
      vertexT *vertex, **vertexp;
      FOREACHvertex_(facet->vertices) {
        if (count < 3) triangle[count] = static_cast<std::uint32_t>(qh_pointid(qh, vertex->point));
        ++count;
      }
      if (count == 3) triangles.push_back(triangle);
    }
  }
  qh_freeqhull(qh, qh_ALL);
  int current_long = 0, total_long = 0;
  qh_memfreeshort(qh, &current_long, &total_long);
  return triangles;
}

Hull Exact(const std::vector<Point>& points) {
  if (points.size() < 4) return {};
  std::vector<Triangle> triangles = Facets(points);
  std::map<std::uint32_t, std::uint32_t> number_of;
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t index : triangle) number_of.emplace(index, 0);
  }
  if (number_of.size() < 4) return {};
  Hull hull;
  Point middle{};
  for (auto& [index, number] : number_of) {
    number = static_cast<std::uint32_t>(hull.vertices.size());
    hull.vertices.push_back(points[index]);
    for (std::size_t k = 0; k < 3; ++k) {
      middle[k] += points[index][k] / static_cast<double>(number_of.size());
    }
  }
  for (Triangle triangle : triangles) {
    const Point &a = points[triangle[0]], &b = points[triangle[1]], &c = points[triangle[2]];
    if (Dot(Cross(Minus(b, a), Minus(c, a)), Minus(a, middle)) < 0) {
      std::swap(triangle[1], triangle[2]);
    }
    for (std::uint32_t& index : triangle) index = number_of.at(index);
    // A triangle begins with its least vertex: the same triangles are written in one way only.
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
    hull.triangles.push_back(triangle);
  }
  std::sort(hull.triangles.begin(), hull.triangles.end());
  return hull;
}

// The points of `points` that are furthest along `count` directions, on a spiral around the ball.
std::vector<Point> Furthest(const std::vector<Point>& points, std::size_t count) {
  std::set<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double angle = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    const double across = std::sqrt(1 - z * z);
    const Point direction = {across * std::cos(angle), across * std::sin(angle), z};
    std::size_t best = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      if (Dot(points[k], direction) > Dot(points[best], direction)) best = k;
    }
    chosen.insert(best);
  }
  std::vector<Point> furthest;
  for (const std::size_t index : chosen) furthest.push_back(points[index]);
  return furthest;
}

}  // namespace

Hull MeshHull(const std::vector<Point>& points, std::size_t most_vertices) {
  Hull hull = Exact(points);
  if (hull.vertices.size() <= most_vertices) return hull;
  return Exact(Furthest(hull.vertices, most_vertices));
}

std::vector<Point> PlateOf(const std::vector<Point>& points) {
  const Point& origin = points.front();
  // The point for which `size` is largest, seen from the first one.
  const auto furthest = [&](auto size) {
    return *std::max_element(points.begin(), points.end(), [&](const Point& a, const Point& b) {
      return size(Minus(a, origin)) < size(Minus(b, origin));
    });
  };
  const auto square = [](const Point& v) { return Dot(v, v); };
  const Point along = Minus(furthest(square), origin);
  const Point across =
      Minus(furthest([&](const Point& v) { return square(Cross(along, v)); }), origin);
  const Point normal = Cross(along, across);
  const double extent = std::sqrt(square(along)), area = std::sqrt(square(normal));
  if (!(area > 1e-9 * extent * extent)) return {};
  constexpr double kHalfOfThickness = 1.0 / 400;
  std::vector<Point> plate;
  for (const Point& point : points) {
    for (const double side : {-1.0, 1.0}) {
      Point moved = point;
      for (std::size_t i = 0; i < 3; ++i) {
        moved[i] += side * kHalfOfThickness * extent * normal[i] / area;
      }
      plate.push_back(moved);
    }
  }
  return plate;
}

}  // namespace tcs
