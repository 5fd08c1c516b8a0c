// Whether the arm meets itself or what stands around it: its links as capsules, the rest as boxes.
#pragma once

#include "examples/arm/arm_model.h"

namespace arm {

// Whether nothing is nearer to anything else than it may be.
bool IsFree(const Joints& q);

}  // namespace arm
