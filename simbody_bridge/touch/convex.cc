#include "simbody_bridge/touch/convex.h"

#include <cmath>
#include <cstddef>

#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

constexpr int kMostRounds = 64;

Vector Scaled(const Vector& v, double by) { return {v[0] * by, v[1] * by, v[2] * by}; }
bool IsZero(const Vector& v) { return Dot(v, v) < 1e-30; }

Vector OnCircle(double radius, const Vector& d) {
  const double across = std::hypot(d[0], d[1]);
  return across > 0 ? Vector{radius * d[0] / across, radius * d[1] / across, 0} : Vector{};
}

// Along `d`, in the shape's own frame.
struct Support {
  const Vector& d;

  Vector operator()(const BoxShape& box) const {
    Vector point;
    for (std::size_t i = 0; i < 3; ++i) point[i] = std::copysign(box.size_m[i] / 2, d[i]);
    return point;
  }
  Vector operator()(const SphereShape& sphere) const {
    return Scaled(d, sphere.radius_m / std::sqrt(Dot(d, d)));
  }
  Vector operator()(const CylinderShape& cylinder) const {
    Vector point = OnCircle(cylinder.radius_m, d);
    point[2] = std::copysign(cylinder.length_m / 2, d[2]);
    return point;
  }
  Vector operator()(const CapsuleShape& capsule) const {
    Vector point = Scaled(d, capsule.radius_m / std::sqrt(Dot(d, d)));
    point[2] += std::copysign(capsule.length_m / 2, d[2]);
    return point;
  }
  Vector operator()(const MeshShape& mesh) const {
    const Vector* farthest = &mesh.mesh->vertices_m.front();
    for (const Vector& vertex : mesh.mesh->vertices_m) {
      if (Dot(vertex, d) > Dot(*farthest, d)) farthest = &vertex;
    }
    return *farthest;
  }
  Vector operator()(const PlaneShape&) const { return {}; }
};

// The points of the difference of two shapes that may enclose the origin, the newest first, and
// where to look for it.
class Simplex {
 public:
  // Takes another point on the way; true: the origin is inside.
  bool Add(const Vector& point, Vector* direction) {
    for (std::size_t i = count_; i > 0; --i) points_[i] = points_[i - 1];
    points_[0] = point;
    ++count_;
    switch (count_) {
      case 1:
        *direction = Scaled(point, -1);
        return IsZero(*direction);
      case 2:
        return Line(direction);
      case 3:
        return Triangle(direction);
      default:
        return Tetrahedron(direction);
    }
  }

 private:
  void Keep(const Vector& a, const Vector& b) {
    points_ = {a, b};
    count_ = 2;
  }

  bool Line(Vector* direction) {
    const Vector a = points_[0], ab = Minus(points_[1], a), ao = Scaled(a, -1);
    if (Dot(ab, ao) <= 0) {
      count_ = 1;
      *direction = ao;
      return IsZero(ao);
    }
    *direction = Cross(Cross(ab, ao), ab);
    return IsZero(*direction);  // the origin is on the line
  }

  bool Triangle(Vector* direction) {
    const Vector a = points_[0], b = points_[1], c = points_[2];
    const Vector ab = Minus(b, a), ac = Minus(c, a), ao = Scaled(a, -1), normal = Cross(ab, ac);
    if (Dot(Cross(normal, ac), ao) > 0) {
      if (Dot(ac, ao) > 0) {
        Keep(a, c);
        *direction = Cross(Cross(ac, ao), ac);
        return IsZero(*direction);
      }
      Keep(a, b);
      return Line(direction);
    }
    if (Dot(Cross(ab, normal), ao) > 0) {
      Keep(a, b);
      return Line(direction);
    }
    const double side = Dot(normal, ao);
    if (side == 0) return true;
    if (side > 0) {
      *direction = normal;
    } else {
      points_[1] = c;
      points_[2] = b;
      *direction = Scaled(normal, -1);
    }
    return false;
  }

  bool Tetrahedron(Vector* direction) {
    const Vector a = points_[0], b = points_[1], c = points_[2], d = points_[3];
    const Vector ao = Scaled(a, -1);
    const auto face = [&](const Vector& p, const Vector& q) {
      if (Dot(Cross(Minus(p, a), Minus(q, a)), ao) <= 0) return false;
      points_[1] = p;
      points_[2] = q;
      count_ = 3;
      return true;
    };
    if (face(b, c) || face(c, d) || face(d, b)) return Triangle(direction);
    return true;
  }

  std::array<Vector, 5> points_{};
  std::size_t count_ = 0;
};

}  // namespace

Vector PlacedConvex::Farthest(const Vector& direction) const {
  const auto& q = pose_.orientation_xyzw;
  const Vector inside = Rotate({-q[0], -q[1], -q[2], q[3]}, direction);
  const Vector point = Rotate(q, std::visit(Support{inside}, geometry_));
  return {point[0] + pose_.position_m[0], point[1] + pose_.position_m[1],
          point[2] + pose_.position_m[2]};
}

bool AreWithin(const PlacedConvex& a, const PlacedConvex& b, double margin_m) {
  Vector direction = Minus(b.pose().position_m, a.pose().position_m);
  if (IsZero(direction)) direction = {1, 0, 0};
  Simplex simplex;
  for (int round = 0; round < kMostRounds; ++round) {
    const Vector ahead = Scaled(direction, margin_m / std::sqrt(Dot(direction, direction)));
    Vector point = Minus(a.Farthest(direction), b.Farthest(Scaled(direction, -1)));
    for (std::size_t i = 0; i < 3; ++i) point[i] += ahead[i];
    if (Dot(point, direction) < 0) return false;
    if (simplex.Add(point, &direction)) return true;
  }
  return true;  // the origin is on the surface, as nearly as can be told
}

bool IsWithin(const PlacedConvex& a, const Pose& plane, double margin_m) {
  const Vector up = Rotate(plane.orientation_xyzw, {0, 0, 1});
  const Vector lowest = a.Farthest(Scaled(up, -1));
  return Dot(up, Minus(lowest, plane.position_m)) <= margin_m;
}

}  // namespace tcs
