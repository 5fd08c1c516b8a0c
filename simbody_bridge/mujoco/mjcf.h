// A forest in MuJoCo's own language, MJCF. Pure: the code needs no MuJoCo.
//
// Names tell which part is which: body and joint 'b3' are those of forest.bodies[3] ('b3x', 'b3y',
// 'b3z' the slides of joints that need them, 'b3' their rotation), site 'b3' is that body's
// frame, actuators 'b3' and 'j4' are the wrench along its axes and the drive of joint 4.
#pragma once

#include <string>

#include "simbody_bridge/model/forest.h"

namespace tcs {

std::string MjcfOf(const Forest& forest, const std::array<double, 3>& gravity_mps2);

// Whether the joint of this index can be driven: it has one coordinate, and mimics none.
bool IsDriven(const Forest& forest, std::size_t joint);

// A free base moves by what MuJoCo calls a free joint, other floating joints by slides and a ball.
bool HasFreeJoint(const TreeBody& body);

}  // namespace tcs
