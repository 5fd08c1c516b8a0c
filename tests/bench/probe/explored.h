// How far stock OMPL gets in some seconds of the program's own clock.
#pragma once

namespace tcs::bench {

// States that OMPL's RRT for a rigid body checks in solve(seconds), whose goal cannot be reached.
double StatesExplored(double seconds);

}  // namespace tcs::bench
