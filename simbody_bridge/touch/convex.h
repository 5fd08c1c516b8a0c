// Whether convex shapes meet: pure geometry, by Gilbert, Johnson and Keerthi.
#pragma once

#include <array>
#include <vector>

#include "simbody_bridge/model/pose.h"
#include "simbody_bridge/model/shape.h"

namespace tcs {

// A shape somewhere in the world; not a plane. A mesh counts as its hull.
class PlacedConvex {
 public:
  // The geometry outlives this.
  PlacedConvex(const Geometry& geometry, const Pose& pose) : geometry_(geometry), pose_(pose) {}

  // The shape's point that is farthest along a direction that is not 0.
  std::array<double, 3> Farthest(const std::array<double, 3>& direction) const;
  const Pose& pose() const { return pose_; }

 private:
  const Geometry& geometry_;
  Pose pose_;
};

// Whether the two are as near to each other as `margin_m`, or overlap.
bool AreWithin(const PlacedConvex& a, const PlacedConvex& b, double margin_m);

// The same, for a shape and everything below z = 0 in the frame of a plane.
bool IsWithin(const PlacedConvex& a, const Pose& plane, double margin_m);

}  // namespace tcs
