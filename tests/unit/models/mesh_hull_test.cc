#include "coordinator/models/mesh_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Points = std::vector<std::array<double, 3>>;

double Volume(const Hull& hull) {
  double volume = 0;
  for (const auto& [a, b, c] : hull.triangles) {
    const auto &p = hull.vertices[a], &q = hull.vertices[b], &r = hull.vertices[c];
    volume += Dot(p, Cross(q, r)) / 6;
  }
  return volume;
}

Points OnTheBall(int count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    const double length = std::sqrt(x * x + y * y + z * z);
    points.push_back({x / length, y / length, z / length});
  }
  return points;
}

TEST(MeshHull, HasTheCornersOfACubeAndNothingElse) {
  Points points;
  for (const double x : {0, 1, 2}) {
    for (const double y : {0, 1, 2}) {
      for (const double z : {0, 1, 2}) points.push_back({x, y, z});
    }
  }
  const Hull hull = MeshHull(points, 512);
  EXPECT_EQ(hull.vertices.size(), 8u);
  EXPECT_EQ(hull.triangles.size(), 12u);
  EXPECT_NEAR(Volume(hull), 8, 1e-12);
}

TEST(MeshHull, IsTheSameWhateverIsWithin) {
  Points points = OnTheBall(100);
  const Hull before = MeshHull(points, 512);
  EXPECT_EQ(before.vertices, points);
  for (int i = 0; i < 100; ++i) points.push_back({0.001 * i, 0, 0.1});
  const Hull after = MeshHull(points, 512);
  EXPECT_EQ(after.vertices, before.vertices);
  EXPECT_EQ(after.triangles, before.triangles);
}

TEST(MeshHull, OfManyVerticesKeepsThoseThatMatter) {
  constexpr std::size_t kMost = 512;
  const Points points = OnTheBall(20'000);
  const Hull hull = MeshHull(points, kMost);
  EXPECT_LE(hull.vertices.size(), kMost);
  EXPECT_GT(hull.vertices.size(), kMost / 2);
  // Along any direction it reaches as far as the ball does, but for what the header says.
  for (const auto& direction : OnTheBall(200)) {
    double reach = 0;
    for (const auto& vertex : hull.vertices) reach = std::max(reach, Dot(vertex, direction));
    EXPECT_GT(reach, 1 - 4.0 / kMost);
  }
}

TEST(MeshHull, OfWhatIsFlatThereIsNone) {
  EXPECT_TRUE(MeshHull({}, 512).vertices.empty());
  EXPECT_TRUE(MeshHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 512).vertices.empty());
  EXPECT_TRUE(MeshHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, 512).vertices.empty());
  EXPECT_TRUE(MeshHull(Points(100, {1, 2, 3}), 512).vertices.empty());
}

}  // namespace
}  // namespace tcs
