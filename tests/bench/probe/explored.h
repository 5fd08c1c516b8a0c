// How far stock OMPL gets in a second of the program's own clock.
#pragma once

namespace tcs::bench {

// States that OMPL's RRT for a rigid body checks in solve(1.0), whose goal cannot be reached.
double StatesExplored();

}  // namespace tcs::bench
