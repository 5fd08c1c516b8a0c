// Vectors in the frames of the world and of a body.
#pragma once

#include <array>

#include "simbody_bridge/model/vectors.h"

namespace tcs {

// A world vector along the axes of a body with the orientation `q`.
inline std::array<double, 3> InBody(const std::array<double, 4>& q,
                                    const std::array<double, 3>& v) {
  return TurnedBy({-q[0], -q[1], -q[2], q[3]}, v);
}

// The other way round: a vector along the body's axes.
inline std::array<double, 3> InWorld(const std::array<double, 4>& q,
                                     const std::array<double, 3>& v) {
  return TurnedBy(q, v);
}

}  // namespace tcs
