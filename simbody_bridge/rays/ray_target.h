// A shape that rays meet, in its own frame. Pure geometry.
#pragma once

#include <array>
#include <limits>
#include <variant>
#include <vector>

#include "simbody_bridge/model/shape.h"

namespace tcs {

// The distance of a ray that meets nothing.
inline constexpr double kMeetsNothing = std::numeric_limits<double>::infinity();

struct Ray {
  std::array<double, 3> origin_m{};
  std::array<double, 3> direction{1, 0, 0};  // of unit length
};

class RayTarget {
 public:
  // A mesh is its convex hull, as where it touches something.
  explicit RayTarget(const Geometry& geometry);

  // How far the ray goes until it enters the solid. A ray that begins inside does not enter the
  // solid.
  double Meet(const Ray& ray) const;

  // A ball around all of the shape, in the shape's frame; infinite around a plane.
  const std::array<double, 3>& center_m() const { return center_m_; }
  double radius_m() const { return radius_m_; }

 private:
  // All points whose product with the normal is at most the offset.
  struct HalfSpace {
    std::array<double, 3> normal;
    double offset_m;
  };
  struct Hull {
    std::vector<HalfSpace> sides;
  };
  struct Meeting;

  Hull TakeHull(const Mesh& mesh);

  std::variant<BoxShape, SphereShape, CylinderShape, CapsuleShape, PlaneShape, Hull> form_;
  std::array<double, 3> center_m_{};
  double radius_m_ = kMeetsNothing;
};

}  // namespace tcs
