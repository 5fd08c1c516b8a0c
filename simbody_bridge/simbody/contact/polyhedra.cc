#include "simbody_bridge/simbody/contact/polyhedra.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simbody_bridge/simbody/tree/smooth.h"

namespace tcs {
namespace {

using SimTK::dot;
using SimTK::Transform;
using SimTK::Vec3;

// More products of edges than these are not looked at: meshes touch each other by their faces.
constexpr std::size_t kMostEdgePairs = 400;
// Edges have to be so much nearer than faces to count: solids that lie flat have both.
constexpr double kEdgeShare = 0.95, kEdgeSlackM = 1e-6;

struct Axis {
  Vec3 normal;  // in the world, from the second towards the first
  double overlap = std::numeric_limits<double>::infinity();
  const Face* face_of_first = nullptr;  // whose normal it is; neither: of two edges
  const Face* face_of_second = nullptr;
};

struct Corner {
  Vec3 at;
  double weight;
};

class Pair {
 public:
  Pair(const Polyhedron& first, const Transform& first_pose, const Polyhedron& second,
       const Transform& second_pose)
      : first_(first), first_pose_(first_pose), second_(second), second_pose_(second_pose) {
    for (const Vec3& corner : first.corners) first_corners_.push_back(first_pose * corner);
    for (const Vec3& corner : second.corners) second_corners_.push_back(second_pose * corner);
  }

  void Find(std::vector<Touch>* touches) {
    if (!AddFaces(first_, first_pose_, second_corners_, true)) return;
    if (!AddFaces(second_, second_pose_, first_corners_, false)) return;
    if (!AddEdges()) return;
    if (best_.face_of_second != nullptr) {
      CutSides(*best_.face_of_second, second_corners_, best_.normal, first_, first_pose_,
               first_corners_, best_.normal, touches);
    } else if (best_.face_of_first != nullptr) {
      CutSides(*best_.face_of_first, first_corners_, -best_.normal, second_, second_pose_,
               second_corners_, best_.normal, touches);
    } else {
      MeetEdges(touches);
    }
  }

 private:
  // False: a face's plane lies between the two.
  bool AddFaces(const Polyhedron& solid, const Transform& pose, const std::vector<Vec3>& others,
                bool is_first) {
    for (const Face& face : solid.faces) {
      const Vec3 normal = pose.R() * face.normal;
      const double offset = face.offset + dot(normal, pose.p());
      double least = std::numeric_limits<double>::infinity();
      for (const Vec3& corner : others) least = std::min(least, dot(normal, corner));
      const double overlap = offset - least;
      if (overlap <= 0) return false;
      if (overlap >= best_.overlap) continue;
      best_ = {is_first ? Vec3(-normal) : normal, overlap, is_first ? &face : nullptr,
               is_first ? nullptr : &face};
    }
    return true;
  }

  bool AddEdges() {
    if (first_.edge_directions.size() * second_.edge_directions.size() > kMostEdgePairs)
      return true;
    const double worth = kEdgeShare * best_.overlap - kEdgeSlackM;
    const Vec3 between = Center(first_corners_) - Center(second_corners_);
    for (const Vec3& a : first_.edge_directions) {
      for (const Vec3& b : second_.edge_directions) {
        Vec3 normal = (first_pose_.R() * a) % (second_pose_.R() * b);
        const double norm = normal.norm();
        if (norm < 1e-6) continue;
        normal /= dot(normal, between) < 0 ? -norm : norm;
        const double overlap = Most(second_corners_, normal) + Most(first_corners_, -normal);
        if (overlap <= 0) return false;
        if (overlap < worth && overlap < best_.overlap) best_ = {normal, overlap, nullptr, nullptr};
      }
    }
    return true;
  }

  static Vec3 Center(const std::vector<Vec3>& corners) {
    Vec3 sum(0);
    for (const Vec3& corner : corners) sum += corner;
    return sum / static_cast<double>(corners.size());
  }
  static double Most(const std::vector<Vec3>& corners, const Vec3& direction) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& corner : corners) most = std::max(most, dot(corner, direction));
    return most;
  }

  // The side of `other` that looks most against `outwards`, the normal of `side`, cut to the part
  // that lies over `side`.
  static void CutSides(const Face& side, const std::vector<Vec3>& side_corners,
                       const Vec3& outwards, const Polyhedron& other, const Transform& other_pose,
                       const std::vector<Vec3>& other_corners, const Vec3& normal,
                       std::vector<Touch>* touches) {
    const Vec3 inwards = ~other_pose.R() * outwards;
    const Face* facing = &other.faces.front();
    for (const Face& face : other.faces) {
      if (dot(face.normal, inwards) < dot(facing->normal, inwards)) facing = &face;
    }
    std::vector<Corner> outline, cut;
    for (const int corner : facing->corners) {
      outline.push_back({other_corners[static_cast<std::size_t>(corner)], 1});
    }
    const auto at = [&](std::size_t i) -> const Vec3& {
      return side_corners[static_cast<std::size_t>(side.corners[i % side.corners.size()])];
    };
    for (std::size_t i = 0; i < side.corners.size(); ++i) {
      const Vec3 into = (outwards % (at(i + 1) - at(i))).normalize();
      Cut(outline, into, dot(into, at(i)), &cut);
      std::swap(outline, cut);
    }
    const double offset = dot(outwards, at(0));
    for (const Corner& corner : outline) {
      const double depth = offset - dot(outwards, corner.at);
      if (depth <= 0 || corner.weight <= 0) continue;
      touches->push_back({corner.at + depth / 2 * outwards, normal, depth, corner.weight});
    }
  }

  // The part of an outline that lies beyond a plane. A corner that leaves fades, and the two points
  // where the outline crosses the plane appear as the corner fades.
  static void Cut(const std::vector<Corner>& outline, const Vec3& into, double offset,
                  std::vector<Corner>* cut) {
    cut->clear();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Corner& from = outline[i];
      const Corner& to = outline[(i + 1) % outline.size()];
      const double from_inside = dot(into, from.at) - offset;
      const double to_inside = dot(into, to.at) - offset;
      if (const double fade = FadeOf(from_inside); fade > 0) {
        cut->push_back({from.at, from.weight * fade});
      }
      if ((from_inside < 0) == (to_inside < 0)) continue;
      const double share = from_inside / (from_inside - to_inside);
      const double left = 1 - FadeOf(std::min(from_inside, to_inside));
      cut->push_back(
          {from.at + share * (to.at - from.at), std::min(from.weight, to.weight) * left});
    }
  }

  // The edge of each solid that reaches farthest towards the other; the two edges cross each other.
  void MeetEdges(std::vector<Touch>* touches) const {
    const auto [a, a_end] = Edge(first_corners_, -best_.normal);
    const auto [b, b_end] = Edge(second_corners_, best_.normal);
    const Vec3 u = a_end - a, v = b_end - b, w = a - b;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return;
    const double s = (uv * dot(v, w) - vv * dot(u, w)) / determinant;
    const double t = (uu * dot(v, w) - uv * dot(u, w)) / determinant;
    if (s < 0 || s > 1 || t < 0 || t > 1) return;
    touches->push_back({(a + s * u + b + t * v) / 2, best_.normal, best_.overlap, 1});
  }
  static std::pair<Vec3, Vec3> Edge(const std::vector<Vec3>& corners, const Vec3& direction) {
    const auto less = [&](const Vec3& a, const Vec3& b) {
      return dot(a, direction) < dot(b, direction);
    };
    const auto most = std::max_element(corners.begin(), corners.end(), less);
    auto next = corners.end();
    for (auto corner = corners.begin(); corner != corners.end(); ++corner) {
      if (corner != most && (next == corners.end() || less(*next, *corner))) next = corner;
    }
    return {*most, *next};
  }

  const Polyhedron& first_;
  const Transform& first_pose_;
  const Polyhedron& second_;
  const Transform& second_pose_;
  std::vector<Vec3> first_corners_, second_corners_;  // in the world
  Axis best_;
};

}  // namespace

double FadeOf(double inside_m) { return SmoothStep(1 + inside_m / kFadeM); }

void FindTouchesOfPolyhedra(const Polyhedron& first, const Transform& first_pose,
                            const Polyhedron& second, const Transform& second_pose,
                            std::vector<Touch>* touches) {
  Pair(first, first_pose, second, second_pose).Find(touches);
}

}  // namespace tcs
