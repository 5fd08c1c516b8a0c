// Finds the mistake in a world before an engine sees it.
#pragma once

#include "simbody_bridge/dynamics.h"

namespace tcs {

// How far an initial orientation may be from unit length; it is normalised when the world is built.
inline constexpr double kQuaternionNormTolerance = 1e-3;

// Throws DynamicsError, one sentence naming the body or the field, at the first value that has no
// physical meaning.
void CheckWorld(const WorldSpec& world);

// The same for a wrench on the body of this name.
void CheckWrench(const std::string& body, const Wrench& wrench);

bool AllFinite(const BodyState& state);

}  // namespace tcs
