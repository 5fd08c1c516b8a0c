#include "simbody_bridge/model/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

constexpr double kFlat = 1e-6;  // of the points' extent

// The hull of the points that have been added so far; each point that is outside replaces the
// triangles that it sees by a cone over their outline.
class Builder {
 public:
  explicit Builder(std::span<const Vector> points) : points_(points) {}

  bool Begin();
  void Add(int point);
  ConvexHull Take() const;

 private:
  struct Face {
    std::array<int, 3> corners;
    Vector normal;  // of unit length
    double offset;
  };
  const Vector& At(int point) const { return points_[static_cast<std::size_t>(point)]; }
  double Above(const Face& face, int point) const {
    return Dot(face.normal, At(point)) - face.offset;
  }
  void AddFace(int a, int b, int c);
  // The point that is farthest by `measure`.
  template <class Measure>
  int Farthest(const Measure& measure) const;

  std::span<const Vector> points_;
  std::vector<Face> faces_;
  std::vector<std::pair<int, int>> outline_;  // memory of Add
  double tolerance_ = 0;
};

template <class Measure>
int Builder::Farthest(const Measure& measure) const {
  int farthest = 0;
  double most = -1;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double far = measure(points_[i]);
    if (far <= most) continue;
    most = far;
    farthest = static_cast<int>(i);
  }
  return farthest;
}

void Builder::AddFace(int a, int b, int c) {
  const Vector normal = Cross(Minus(At(b), At(a)), Minus(At(c), At(a)));
  const double norm = std::sqrt(Dot(normal, normal));
  if (!(norm > 0)) return;
  const Vector unit = {normal[0] / norm, normal[1] / norm, normal[2] / norm};
  faces_.push_back({{a, b, c}, unit, Dot(unit, At(a))});
}

// A tetrahedron of points that are far from each other.
bool Builder::Begin() {
  if (points_.size() < 4) return false;
  const auto from = [&](int point) {
    return [this, point](const Vector& p) { return Dot(Minus(p, At(point)), Minus(p, At(point))); };
  };
  const int a = Farthest(from(0)), b = Farthest(from(a));
  const Vector line = Minus(At(b), At(a));
  const double extent = std::sqrt(Dot(line, line));
  tolerance_ = kFlat * extent;
  const int c = Farthest([&](const Vector& p) {
    const Vector cross = Cross(line, Minus(p, At(a)));
    return Dot(cross, cross);
  });
  const Vector normal = Cross(line, Minus(At(c), At(a)));
  const double norm = std::sqrt(Dot(normal, normal));
  if (!(norm > tolerance_ * extent)) return false;
  const auto height = [&](const Vector& p) { return Dot(normal, Minus(p, At(a))) / norm; };
  const int d = Farthest([&](const Vector& p) { return std::abs(height(p)); });
  if (!(std::abs(height(At(d))) > tolerance_)) return false;
  const bool is_above = height(At(d)) > 0;
  const int left = is_above ? c : b, right = is_above ? b : c;
  AddFace(a, left, right);
  AddFace(a, right, d);
  AddFace(right, left, d);
  AddFace(left, a, d);
  return true;
}

void Builder::Add(int point) {
  outline_.clear();
  const auto is_seen = [&](const Face& face) { return Above(face, point) > tolerance_; };
  for (const Face& face : faces_) {
    if (!is_seen(face)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = face.corners[i], to = face.corners[(i + 1) % 3];
      const auto back = std::find(outline_.begin(), outline_.end(), std::pair(to, from));
      if (back != outline_.end()) {
        *back = outline_.back();
        outline_.pop_back();
      } else {
        outline_.emplace_back(from, to);
      }
    }
  }
  std::erase_if(faces_, is_seen);
  std::sort(outline_.begin(), outline_.end());
  for (const auto& [from, to] : outline_) AddFace(from, to, point);
}

ConvexHull Builder::Take() const {
  ConvexHull hull;
  std::map<int, int> number;
  for (const Face& face : faces_) {
    std::array<int, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [known, is_new] =
          number.try_emplace(face.corners[i], static_cast<int>(hull.vertices.size()));
      if (is_new) hull.vertices.push_back(At(face.corners[i]));
      corners[i] = known->second;
    }
    hull.triangles.push_back(corners);
  }
  return hull;
}

}  // namespace

bool SpansVolume(std::span<const Vector> points) { return Builder(points).Begin(); }

std::optional<ConvexHull> HullOf(std::span<const Vector> points) {
  Builder builder(points);
  if (!builder.Begin()) return {};
  for (std::size_t i = 0; i < points.size(); ++i) builder.Add(static_cast<int>(i));
  return builder.Take();
}

}  // namespace tcs
