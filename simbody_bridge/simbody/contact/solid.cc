#include "simbody_bridge/simbody/contact/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simbody_bridge/model/convex_hull.h"
#include "simbody_bridge/simbody/contact/near_directions.h"
#include "simbody_bridge/simbody/vectors.h"

namespace tcs {
namespace {

using SimTK::dot;
using SimTK::Vec3;

constexpr int kPrismSides = 24;
constexpr double kSameDirection = 1e-6;

void AddFace(std::vector<int> corners, Polyhedron* solid) {
  const auto at = [&](std::size_t i) -> const Vec3& {
    return solid->corners[static_cast<std::size_t>(corners[i])];
  };
  const Vec3 normal = ((at(1) - at(0)) % (at(2) - at(0))).normalize();
  const double offset = dot(normal, at(0));
  solid->faces.push_back({std::move(corners), normal, offset});
}

void FindEdges(Polyhedron* solid) {
  NearDirections directions(2 * kSameDirection);
  auto& known = solid->edge_directions;
  for (const Face& face : solid->faces) {
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const auto from = static_cast<std::size_t>(face.corners[i]);
      const auto to = static_cast<std::size_t>(face.corners[(i + 1) % face.corners.size()]);
      const Vec3 direction = (solid->corners[to] - solid->corners[from]).normalize();
      const auto is_same = [&](std::size_t other) {
        return (known[other] % direction).normSqr() < kSameDirection * kSameDirection;
      };
      if (directions.HasAny(direction, is_same) || directions.HasAny(-direction, is_same)) continue;
      directions.Add(direction, known.size());
      known.push_back(direction);
    }
  }
}

Polyhedron BoxOf(const BoxShape& box) {
  Polyhedron solid;
  const Vec3 half = ToVec3(box.size_m) / 2;
  for (int i = 0; i < 8; ++i) {
    solid.corners.emplace_back((i & 1) != 0 ? half[0] : -half[0], (i & 2) != 0 ? half[1] : -half[1],
                               (i & 4) != 0 ? half[2] : -half[2]);
  }
  for (const auto& corners : {std::vector{0, 4, 6, 2},
                              {1, 3, 7, 5},
                              {0, 1, 5, 4},
                              {2, 6, 7, 3},
                              {0, 2, 3, 1},
                              {4, 5, 7, 6}}) {
    AddFace(corners, &solid);
  }
  FindEdges(&solid);
  return solid;
}

Polyhedron PrismOf(const CylinderShape& cylinder) {
  Polyhedron solid;
  std::vector<int> top, bottom;
  for (int i = 0; i < kPrismSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPrismSides;
    const double x = cylinder.radius_m * std::cos(angle), y = cylinder.radius_m * std::sin(angle);
    solid.corners.emplace_back(x, y, -cylinder.length_m / 2);
    solid.corners.emplace_back(x, y, cylinder.length_m / 2);
    bottom.insert(bottom.begin(), 2 * i);
    top.push_back(2 * i + 1);
  }
  for (int i = 0; i < kPrismSides; ++i) {
    const int next = (i + 1) % kPrismSides;
    AddFace({2 * i, 2 * next, 2 * next + 1, 2 * i + 1}, &solid);
  }
  AddFace(bottom, &solid);
  AddFace(top, &solid);
  FindEdges(&solid);
  return solid;
}

// Triangles that lie in one plane are one face: a corner is where its outline turns.
Polyhedron HullOfMesh(const Mesh& mesh) {
  Polyhedron solid;
  const std::optional<ConvexHull> hull = HullOf(mesh.vertices_m);
  if (!hull.has_value()) return solid;  // never: CheckShape refuses it
  for (const auto& vertex : hull->vertices) solid.corners.push_back(ToVec3(vertex));
  struct Plane {
    Vec3 normal;
    double offset;
  };
  constexpr double kSameNormal = 1e-5;
  std::vector<Plane> planes;
  NearDirections normals(kSameNormal);
  double extent = 0;
  for (const Vec3& corner : solid.corners) extent = std::max(extent, corner.norm());
  for (const auto& [a, b, c] : hull->triangles) {
    const auto at = [&](int i) -> const Vec3& {
      return solid.corners[static_cast<std::size_t>(i)];
    };
    const Vec3 normal = ((at(b) - at(a)) % (at(c) - at(a))).normalize();
    const double offset = dot(normal, at(a));
    const bool is_known = normals.HasAny(normal, [&](std::size_t plane) {
      return (planes[plane].normal - normal).norm() < kSameNormal &&
             std::abs(planes[plane].offset - offset) < 1e-5 * extent;
    });
    if (is_known) continue;
    normals.Add(normal, planes.size());
    planes.push_back({normal, offset});
  }
  for (const Plane& plane : planes) {
    std::vector<int> corners;
    Vec3 center(0);
    for (std::size_t i = 0; i < solid.corners.size(); ++i) {
      if (std::abs(dot(plane.normal, solid.corners[i]) - plane.offset) > 1e-5 * extent) continue;
      corners.push_back(static_cast<int>(i));
      center += solid.corners[i];
    }
    if (corners.size() < 3) continue;
    center /= static_cast<double>(corners.size());
    const Vec3 x = (solid.corners[static_cast<std::size_t>(corners[0])] - center).normalize();
    const Vec3 y = plane.normal % x;
    const auto angle = [&](int corner) {
      const Vec3 arm = solid.corners[static_cast<std::size_t>(corner)] - center;
      return std::atan2(dot(arm, y), dot(arm, x));
    };
    std::sort(corners.begin(), corners.end(), [&](int a, int b) { return angle(a) < angle(b); });
    solid.faces.push_back({corners, plane.normal, plane.offset});
  }
  FindEdges(&solid);
  return solid;
}

Vec3 NearestOfSegment(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 line = b - a;
  const double along = std::clamp(dot(point - a, line) / line.normSqr(), 0.0, 1.0);
  return a + along * line;
}

// The face's point that is nearest to a point in front of the face's plane: inside the face's
// outline, or on it.
Vec3 NearestOfFace(const Polyhedron& solid, const Face& face, const Vec3& point) {
  const auto at = [&](std::size_t i) -> const Vec3& {
    return solid.corners[static_cast<std::size_t>(face.corners[i % face.corners.size()])];
  };
  bool is_inside = true;
  Vec3 nearest = at(0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < face.corners.size(); ++i) {
    const Vec3 outwards = (at(i + 1) - at(i)) % face.normal;
    if (dot(point - at(i), outwards) <= 0) continue;
    is_inside = false;
    const Vec3 candidate = NearestOfSegment(at(i), at(i + 1), point);
    const double far = (point - candidate).normSqr();
    if (far < least) {
      least = far;
      nearest = candidate;
    }
  }
  return is_inside ? point - (dot(face.normal, point) - face.offset) * face.normal : nearest;
}

Nearness NearestOfPolyhedron(const Polyhedron& solid, const Vec3& point) {
  const Face* highest = &solid.faces.front();
  double above = -std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  Vec3 nearest(0);
  for (const Face& face : solid.faces) {
    const double height = dot(face.normal, point) - face.offset;
    if (height > above) {
      above = height;
      highest = &face;
    }
    if (height <= 0) continue;
    const Vec3 candidate = NearestOfFace(solid, face, point);
    const double far = (point - candidate).norm();
    if (far < least) {
      least = far;
      nearest = candidate;
    }
  }
  if (above <= 0 || least == 0) return {above, highest->normal};
  return {least, (point - nearest) / least};
}

Nearness NearestOfCylinder(double radius, double half_length, const Vec3& p) {
  const double across = std::hypot(p[0], p[1]);
  const Vec3 out = across > 0 ? Vec3(p[0] / across, p[1] / across, 0) : Vec3(1, 0, 0);
  const Vec3 up(0, 0, p[2] < 0 ? -1 : 1);
  const double beside = across - radius, above = std::abs(p[2]) - half_length;
  if (beside > 0 && above > 0) {
    const double distance = std::hypot(beside, above);
    return {distance, (beside * out + above * up) / distance};
  }
  return beside > above ? Nearness{beside, out} : Nearness{above, up};
}

Nearness NearestOfRound(double radius, double half_length, const Vec3& p) {
  const Vec3 arm = p - Vec3(0, 0, std::clamp(p[2], -half_length, half_length));
  const double far = arm.norm();
  return {far - radius, far > 0 ? arm / far : Vec3(1, 0, 0)};
}

}  // namespace

Solid::Solid(const Geometry& geometry) : kind_(Kind::kPolyhedron) {
  if (const auto* box = std::get_if<BoxShape>(&geometry)) {
    polyhedron_ = BoxOf(*box);
  } else if (const auto* mesh = std::get_if<MeshShape>(&geometry)) {
    polyhedron_ = HullOfMesh(*mesh->mesh);
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&geometry)) {
    kind_ = Kind::kCylinder;
    radius_ = cylinder->radius_m;
    half_length_ = cylinder->length_m / 2;
    polyhedron_ = PrismOf(*cylinder);
  } else if (const auto* sphere = std::get_if<SphereShape>(&geometry)) {
    kind_ = Kind::kRound;
    radius_ = sphere->radius_m;
  } else if (const auto* capsule = std::get_if<CapsuleShape>(&geometry)) {
    kind_ = Kind::kRound;
    radius_ = capsule->radius_m;
    half_length_ = capsule->length_m / 2;
  } else {
    kind_ = Kind::kPlane;
  }
  for (const Vec3& corner : polyhedron_.corners) reach_ = std::max(reach_, corner.norm());
  if (kind_ == Kind::kRound) reach_ = radius_ + half_length_;
  if (kind_ == Kind::kPlane) reach_ = std::numeric_limits<double>::infinity();
}

Nearness Solid::NearestTo(const Vec3& point) const {
  switch (kind_) {
    case Kind::kPlane:
      return {point[2], Vec3(0, 0, 1)};
    case Kind::kRound:
      return NearestOfRound(radius_, half_length_, point);
    case Kind::kCylinder:
      return NearestOfCylinder(radius_, half_length_, point);
    case Kind::kPolyhedron:
      break;
  }
  return NearestOfPolyhedron(polyhedron_, point);
}

}  // namespace tcs
