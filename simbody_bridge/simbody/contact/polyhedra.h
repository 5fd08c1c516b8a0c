// Where two polyhedra touch: the direction in which they overlap least (of their faces' normals and
// their edges' products) is the normal; the side of the one, cut to the side of the other that it
// lies on, gives the points.
#pragma once

#include <vector>

#include "simbody_bridge/simbody/contact/touch.h"

namespace tcs {

void FindTouchesOfPolyhedra(const Polyhedron& first, const SimTK::Transform& first_pose,
                            const Polyhedron& second, const SimTK::Transform& second_pose,
                            std::vector<Touch>* touches);

// How far beyond a side's edge a point fades from a whole one to none.
inline constexpr double kFadeM = 1e-3;
// The weight of a point so far inside an edge; less than 0 outside.
double FadeOf(double inside_m);

}  // namespace tcs
