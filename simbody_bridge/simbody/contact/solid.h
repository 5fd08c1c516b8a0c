// A shape as contact needs it, in its own frame: how far points are from it, and its corners and
// faces if it has any.
#pragma once

#include <vector>

#include "simbody_bridge/model/shape.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

// How near a solid is to a point.
struct Nearness {
  double distance;     // less than 0 inside
  SimTK::Vec3 normal;  // outwards, of unit length: the distance grows that way
};

// A flat side: its corners counterclockwise as seen from outside.
struct Face {
  std::vector<int> corners;
  SimTK::Vec3 normal;
  double offset;  // of its plane, along the normal
};

// A solid with flat sides.
struct Polyhedron {
  std::vector<SimTK::Vec3> corners;
  std::vector<Face> faces;
  std::vector<SimTK::Vec3> edge_directions;  // each once, of unit length
};

class Solid {
 public:
  enum class Kind { kPlane, kRound, kCylinder, kPolyhedron };

  // The shape has passed CheckShape.
  explicit Solid(const Geometry& geometry);

  Kind kind() const { return kind_; }
  // The radius of a ball around the origin of the frame that the solid lies in; of a plane
  // infinite.
  double reach() const { return reach_; }
  // Of a round solid or a cylinder: the half length of a line along z, around which the solid has
  // the radius; of a ball 0.
  double radius() const { return radius_; }
  double half_length() const { return half_length_; }
  // The polyhedron itself; of a cylinder a prism that stands for it among cylinders.
  const Polyhedron& polyhedron() const { return polyhedron_; }

  Nearness NearestTo(const SimTK::Vec3& point) const;

 private:
  Kind kind_;
  double reach_ = 0, radius_ = 0, half_length_ = 0;
  Polyhedron polyhedron_;
};

}  // namespace tcs
