// The shapes with which bodies touch each other.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "simbody_bridge/model/pose.h"

namespace tcs {

// Each shape is centred on the origin of its own frame.
struct BoxShape {
  std::array<double, 3> size_m{1, 1, 1};  // whole edges, along x, y, z
};
struct SphereShape {
  double radius_m = 0.5;
};
// Around the z axis.
struct CylinderShape {
  double radius_m = 0.5;
  double length_m = 1;
};
// A cylinder around the z axis with half a ball on each end.
struct CapsuleShape {
  double radius_m = 0.5;
  double length_m = 1;  // of the cylinder, without the balls
};
// Everything below z = 0, without an end. Only the world has planes: no body is as large.
struct PlaneShape {};

struct Mesh {
  std::string name;  // for messages: the file
  std::vector<std::array<double, 3>> vertices_m;
  // Vertices by index, counterclockwise as seen from outside.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
// Collides as the convex hull of its vertices. Already scaled; shared by all shapes that have the
// same mesh (never null).
struct MeshShape {
  std::shared_ptr<const Mesh> mesh;
};

using Geometry =
    std::variant<BoxShape, SphereShape, CylinderShape, CapsuleShape, PlaneShape, MeshShape>;

struct Shape {
  std::string name;  // may be empty
  Geometry geometry;
  Pose pose;  // in the link's frame; of a shape of the world, in the world
  // Coulomb's coefficient, static and sliding. Of two shapes in contact the smaller one acts.
  double friction = 0.8;
};

}  // namespace tcs
