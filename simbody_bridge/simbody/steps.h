// The common part of Simbody's steps, whichever engine takes them.
#pragma once

#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// The length of a step that nothing limits.
inline constexpr VirtualDuration kLongestStep = VirtualDuration::Seconds(1000);

// How long a step of these bodies may be at the most for error control to see the walls
// and the gusts.
VirtualDuration LongestStepBeside(const WorldSpec& world, const std::vector<int>& bodies);

// The state of free bodies `after_s` from the beginning of a step that was taken, before its end: a
// cubic through both ends and their derivatives, of the same order as the methods.
void Interpolate(const IslandStep& step, double after_s, std::vector<double>* state);
// The same, for any numbers; quaternions among them lose some of their length.
void InterpolateNumbers(const IslandStep& step, double after_s, std::vector<double>* state);

// With set steps, where integrators do not interpolate: the state at the end of a step that is
// shortened to end `after` its beginning. `memory` is used again.
void TakeShortened(IslandEngine& engine, const IslandStep& step, VirtualDuration after,
                   IslandStep* memory, std::vector<double>* state);

}  // namespace tcs
