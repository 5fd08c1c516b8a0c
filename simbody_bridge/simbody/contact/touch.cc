#include "simbody_bridge/simbody/contact/touch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "simbody_bridge/simbody/contact/polyhedra.h"

namespace tcs {
namespace {

using SimTK::dot;
using SimTK::Transform;
using SimTK::Vec3;
using Kind = Solid::Kind;

constexpr int kStandingPoints = 6;  // of each rim of a cylinder that stands

// The points of a cylinder that are lowest against `normal` (in its frame): where it lies or rolls
// three points along the line on which it does, a round of points on each rim where it stands;
// `each` takes a point and its weight.
//
// Simpson's weights give the line's load and its moments. A wheel turns round on the point in the
// middle: by its two rims alone it would turn round one of these, as if the wheels were nearer to
// each other, or farther apart, by their width.
template <class Each>
void ForEachRimPoint(const Solid& cylinder, const Vec3& normal, const Each& each) {
  const double across = std::hypot(normal[0], normal[1]);
  const double standing = std::min(1.0, normal[2] * normal[2]);
  if (across > 1e-9 && standing < 1) {
    const double x = -normal[0] / across, y = -normal[1] / across;
    for (const auto& [share, along] : {std::pair{1.0 / 3, -1.0}, {4.0 / 3, 0.0}, {1.0 / 3, 1.0}}) {
      each(Vec3(cylinder.radius() * x, cylinder.radius() * y, along * cylinder.half_length()),
           share * (1 - standing));
    }
  }
  for (const double z : {-cylinder.half_length(), cylinder.half_length()}) {
    if (standing < 1e-6) continue;
    for (int i = 0; i < kStandingPoints; ++i) {
      const double angle = 2 * std::numbers::pi * i / kStandingPoints;
      each(Vec3(cylinder.radius() * std::cos(angle), cylinder.radius() * std::sin(angle), z),
           standing);
    }
  }
}

// The point of a solid's axis that is nearest to another one, whose distance along a line has one
// valley.
double NearestOnAxis(const Solid& round, const Transform& in_other, const Solid& other) {
  const auto distance = [&](double z) {
    return other.NearestTo(in_other * Vec3(0, 0, z)).distance;
  };
  constexpr double kGolden = 0.6180339887498949;
  double low = -round.half_length(), high = round.half_length();
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = distance(left), at_right = distance(right);
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = distance(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = distance(right);
    }
  }
  return (low + high) / 2;
}

// Touches of a ball, or of a line of balls: its ends, and between them the point that is deeper
// than both.
void TouchRound(const PlacedSolid& round, const PlacedSolid& other, std::vector<Touch>* touches) {
  const Transform in_other = ~other.pose * round.pose;
  const double radius = round.solid.radius();
  double deepest = 0;
  const auto add = [&](double z, bool is_between) {
    const Nearness near = other.solid.NearestTo(in_other * Vec3(0, 0, z));
    const double depth = radius - near.distance;
    const double weight = is_between ? (depth - deepest) / depth : 1;
    if (depth <= 0 || weight <= 0) return;
    deepest = std::max(deepest, depth);
    const Vec3 normal = other.pose.R() * near.normal;
    touches->push_back(
        {round.pose * Vec3(0, 0, z) - (radius - depth / 2) * normal, normal, depth, weight});
  };
  add(-round.solid.half_length(), false);
  if (round.solid.half_length() == 0) return;
  add(round.solid.half_length(), false);
  if (other.solid.kind() == Kind::kPlane) return;
  add(NearestOnAxis(round.solid, in_other, other.solid), true);
}

void TouchPlane(const PlacedSolid& solid, const PlacedSolid& plane, std::vector<Touch>* touches) {
  const Vec3 normal = plane.pose.z();
  const auto add = [&](const Vec3& point, double weight) {
    const Vec3 at = solid.pose * point;
    const double depth = -dot(at - plane.pose.p(), normal);
    if (depth > 0) touches->push_back({at + depth / 2 * normal, normal, depth, weight});
  };
  if (solid.solid.kind() == Kind::kCylinder) {
    ForEachRimPoint(solid.solid, ~solid.pose.R() * normal, add);
  } else {
    for (const Vec3& corner : solid.solid.polyhedron().corners) add(corner, 1);
  }
}

// A cylinder touches on the side, the edge or the corner that it overlaps least.
void TouchCylinder(const PlacedSolid& cylinder, const PlacedSolid& other,
                   std::vector<Touch>* touches) {
  const Polyhedron& solid = other.solid.polyhedron();
  const Transform in_other = ~other.pose * cylinder.pose;
  const Vec3 center = in_other.p();
  const auto reach_against = [&](const Vec3& normal) {
    const Vec3 own = ~in_other.R() * normal;
    return cylinder.solid.radius() * std::hypot(own[0], own[1]) +
           cylinder.solid.half_length() * std::abs(own[2]);
  };
  const Face* side = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Face& face : solid.faces) {
    const double overlap = face.offset - dot(face.normal, center) + reach_against(face.normal);
    if (overlap <= 0) return;
    if (overlap < least) {
      least = overlap;
      side = &face;
    }
  }
  Vec3 normal = side->normal;
  double offset = side->offset;
  const Nearness near = other.solid.NearestTo(center);
  if (near.distance > 0) {
    const double overlap = reach_against(near.normal) - near.distance;
    if (overlap <= 0) return;
    if (overlap < 0.99 * least) {
      side = nullptr;
      normal = near.normal;
      offset = dot(normal, center) - near.distance;
    }
  }
  const Vec3 in_world = other.pose.R() * normal;
  const auto add = [&](const Vec3& point, double depth, double weight) {
    if (depth <= 0 || weight <= 0) return;
    touches->push_back({other.pose * (point + depth / 2 * normal), in_world, depth, weight});
  };
  ForEachRimPoint(cylinder.solid, ~in_other.R() * normal, [&](const Vec3& rim, double weight) {
    const Vec3 point = in_other * rim;
    for (const Face& face : solid.faces) {
      if (side == nullptr || &face == side) continue;
      weight *= FadeOf(face.offset - dot(face.normal, point));
    }
    add(point, offset - dot(normal, point), weight);
  });
  // Corners under the cylinder's end.
  for (const Vec3& corner : solid.corners) {
    const Nearness in_cylinder = cylinder.solid.NearestTo(~in_other * corner);
    if (in_cylinder.distance >= 0) continue;
    if (dot(in_other.R() * in_cylinder.normal, normal) > -0.7) continue;
    add(corner + in_cylinder.distance * normal, -in_cylinder.distance, 1);
  }
}

void FindInOrder(const PlacedSolid& first, const PlacedSolid& second, std::vector<Touch>* touches) {
  if (first.solid.kind() == Kind::kRound) {
    TouchRound(first, second, touches);
  } else if (second.solid.kind() == Kind::kPlane) {
    TouchPlane(first, second, touches);
  } else if (first.solid.kind() == Kind::kCylinder && second.solid.kind() == Kind::kPolyhedron) {
    TouchCylinder(first, second, touches);
  } else {
    FindTouchesOfPolyhedra(first.solid.polyhedron(), first.pose, second.solid.polyhedron(),
                           second.pose, touches);
  }
}

// The rank by which one of two solids comes first, as FindInOrder has them.
int Rank(const Solid& solid) {
  switch (solid.kind()) {
    case Kind::kRound:
      return 0;
    case Kind::kCylinder:
      return 1;
    case Kind::kPolyhedron:
      return 2;
    case Kind::kPlane:
      break;
  }
  return 3;
}

}  // namespace

void FindTouches(const PlacedSolid& first, const PlacedSolid& second, std::vector<Touch>* touches) {
  if (Rank(first.solid) <= Rank(second.solid)) {
    FindInOrder(first, second, touches);
    return;
  }
  const std::size_t known = touches->size();
  FindInOrder(second, first, touches);
  for (std::size_t i = known; i < touches->size(); ++i) {
    (*touches)[i].normal = -(*touches)[i].normal;
  }
}

double GapBetween(const PlacedSolid& first, const PlacedSolid& second) {
  const auto gap = [](const PlacedSolid& ball, const PlacedSolid& other) {
    if (ball.solid.kind() == Kind::kPlane) return -std::numeric_limits<double>::infinity();
    return other.solid.NearestTo(~other.pose * ball.pose.p()).distance - ball.solid.reach();
  };
  return std::max(gap(first, second), gap(second, first));
}

}  // namespace tcs
