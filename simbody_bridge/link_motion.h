// Where links are between two instants at which they were read.
#pragma once

#include "simbody_bridge/dynamics.h"

namespace tcs {

// The pose of a link that was `from` and is `to` so many `seconds` later, at the share `part` (0 to
// 1) of that time: the position is a cubic through both ends and their velocities, the orientation
// turns at a steady rate. Less than half a turn lies between the two.
Pose PoseBetween(const LinkState& from, const LinkState& to, double seconds, double part);

// How a frame moves that is fixed to a link, at `at` in the link's frame.
LinkState Mounted(const LinkState& link, const Pose& at);

// The shortest rotation from one orientation to another: a vector along its axis, as long as its
// angle in rad, in the frame of `from`.
std::array<double, 3> TurnBetween(const std::array<double, 4>& from,
                                  const std::array<double, 4>& to);
// The other way round: the orientation turned so, about its own axes.
std::array<double, 4> Turned(const std::array<double, 4>& q, const std::array<double, 3>& turn_rad);

}  // namespace tcs
