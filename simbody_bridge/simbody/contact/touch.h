// Where two solids touch. Touches change without a jump as the solids move, but for where another
// side of a solid becomes the nearest.
#pragma once

#include <vector>

#include "simbody_bridge/simbody/contact/solid.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

// In the world.
struct Touch {
  SimTK::Vec3 point;
  SimTK::Vec3 normal;  // from the second solid towards the first
  double depth;        // more than 0
  double weight;       // how much of a point it is: less than 1 where it fades
};

struct PlacedSolid {
  const Solid& solid;
  const SimTK::Transform& pose;  // in the world
};

// Appends to `touches`.
void FindTouches(const PlacedSolid& first, const PlacedSolid& second, std::vector<Touch>* touches);

// The solids are at least as far from each other; less than 0: they may touch.
double GapBetween(const PlacedSolid& first, const PlacedSolid& second);

}  // namespace tcs
