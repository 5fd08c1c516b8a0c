#include "simbody_bridge/touch/overlaps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <variant>

#include "simbody_bridge/model/rigid_tree.h"
#include "simbody_bridge/model/vectors.h"
#include "simbody_bridge/touch/convex.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

// By so much shapes are made smaller on each side.
constexpr double kSkinM = 0.5e-3;

std::array<double, 4> Turn(const Vector& axis, double angle) {
  const double s = std::sin(angle / 2);
  return {s * axis[0], s * axis[1], s * axis[2], std::cos(angle / 2)};
}

// The pose of the joint's child in the joint's frame.
Pose Moved(const TreeBody& body) {
  const std::vector<double>& q = body.position;
  Pose pose;
  switch (body.kind) {
    case JointKind::kRevolute:
    case JointKind::kContinuous:
      pose.orientation_xyzw = Turn(body.axis, q[0]);
      return pose;
    case JointKind::kPrismatic:
      for (std::size_t i = 0; i < 3; ++i) pose.position_m[i] = q[0] * body.axis[i];
      return pose;
    case JointKind::kPlanar:
      pose.position_m = Rotate(FromZTo(body.axis), {q[0], q[1], 0});
      pose.orientation_xyzw = Turn(body.axis, q[2]);
      return pose;
    case JointKind::kFloating:
      return {{q[0], q[1], q[2]}, Normalised({q[3], q[4], q[5], q[6]})};
    case JointKind::kFixed:
      break;
  }
  return pose;
}

std::vector<Pose> PosesOf(const RobotModel& model, const RigidTree& tree) {
  std::vector<Pose> bodies;
  for (const TreeBody& body : tree.bodies) {
    const Pose parent =
        body.parent == kWorldBody ? Pose{} : bodies[static_cast<std::size_t>(body.parent)];
    bodies.push_back(Times(Times(parent, body.origin), Moved(body)));
  }
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    const Pose body =
        link.body == kWorldBody ? Pose{} : bodies[static_cast<std::size_t>(link.body)];
    poses.push_back(Times(body, link.pose));
  }
  return poses;
}

// Nothing is left of a shape that is thinner than two skins.
struct Smaller {
  static double Less(double size_m, double by_m) { return std::max(size_m - by_m, 1e-6); }

  Geometry operator()(const BoxShape& box) const {
    BoxShape smaller;
    for (std::size_t i = 0; i < 3; ++i) smaller.size_m[i] = Less(box.size_m[i], 2 * kSkinM);
    return smaller;
  }
  Geometry operator()(const SphereShape& sphere) const {
    return SphereShape{Less(sphere.radius_m, kSkinM)};
  }
  Geometry operator()(const CylinderShape& cylinder) const {
    return CylinderShape{Less(cylinder.radius_m, kSkinM), Less(cylinder.length_m, 2 * kSkinM)};
  }
  Geometry operator()(const CapsuleShape& capsule) const {
    return CapsuleShape{Less(capsule.radius_m, kSkinM), capsule.length_m};
  }
  Geometry operator()(const PlaneShape& plane) const { return plane; }
  // Towards the middle: corners by more than sides.
  Geometry operator()(const MeshShape& shape) const {
    auto smaller = std::make_shared<Mesh>();
    Vector middle{};
    for (const Vector& vertex : shape.mesh->vertices_m) {
      for (std::size_t i = 0; i < 3; ++i) {
        middle[i] += vertex[i] / static_cast<double>(shape.mesh->vertices_m.size());
      }
    }
    for (const Vector& vertex : shape.mesh->vertices_m) {
      const Vector out = Minus(vertex, middle);
      const double length = std::sqrt(Dot(out, out));
      const double part = length > 0 ? Less(length, 2 * kSkinM) / length : 1;
      smaller->vertices_m.push_back(
          {middle[0] + part * out[0], middle[1] + part * out[1], middle[2] + part * out[2]});
    }
    return MeshShape{smaller};
  }
};

// The radius of a ball around the origin of its frame that holds the shape.
struct Reach {
  double operator()(const BoxShape& box) const {
    return std::sqrt(Dot(box.size_m, box.size_m)) / 2;
  }
  double operator()(const SphereShape& sphere) const { return sphere.radius_m; }
  double operator()(const CylinderShape& cylinder) const {
    return std::hypot(cylinder.radius_m, cylinder.length_m / 2);
  }
  double operator()(const CapsuleShape& capsule) const {
    return capsule.radius_m + capsule.length_m / 2;
  }
  double operator()(const PlaneShape&) const { return 0; }
  double operator()(const MeshShape& shape) const {
    double most = 0;
    for (const Vector& vertex : shape.mesh->vertices_m) most = std::max(most, Dot(vertex, vertex));
    return std::sqrt(most);
  }
};

struct Part {
  int link;
  Geometry geometry;
  Pose pose;
  double reach_m;
};

bool AreApart(const Part& a, const Part& b) {
  const Vector between = Minus(a.pose.position_m, b.pose.position_m);
  return std::sqrt(Dot(between, between)) > a.reach_m + b.reach_m;
}

}  // namespace

std::vector<Pose> StartingPoses(const RobotModel& model) { return PosesOf(model, MakeTree(model)); }

std::vector<std::pair<int, int>> OverlappingLinks(const RobotModel& model) {
  const RigidTree tree = MakeTree(model);
  const std::vector<Pose> poses = PosesOf(model, tree);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const Shape& shape : model.links[i].shapes) {
      Geometry smaller = std::visit(Smaller{}, shape.geometry);
      const double reach_m = std::visit(Reach{}, smaller);
      parts.push_back(
          {static_cast<int>(i), std::move(smaller), Times(poses[i], shape.pose), reach_m});
    }
  }
  const auto body_of = [&](int link) { return tree.links[static_cast<std::size_t>(link)].body; };
  const auto hangs_on = [&](int body, int on) {
    return body != kWorldBody && tree.bodies[static_cast<std::size_t>(body)].parent == on;
  };
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t k = i + 1; k < parts.size(); ++k) {
      const Part &a = parts[i], &b = parts[k];
      const int body = body_of(a.link), other = body_of(b.link);
      if (body == other || hangs_on(body, other) || hangs_on(other, body)) continue;
      const std::pair<int, int> pair = std::minmax(a.link, b.link);
      if (Ignores(model, pair.first, pair.second) ||
          std::ranges::find(pairs, pair) != pairs.end()) {
        continue;
      }
      if (AreApart(a, b)) continue;
      if (!AreWithin(PlacedConvex(a.geometry, a.pose), PlacedConvex(b.geometry, b.pose), 0)) {
        continue;
      }
      pairs.push_back(pair);
    }
  }
  return pairs;
}

}  // namespace tcs
