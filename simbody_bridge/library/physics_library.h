// The engines are a library of their own, because they take longer to load than all else of tcsim:
// most programs that tcsim runs have no world, and most of its commands run nothing. Where this
// library is linked, MakeDynamics() loads that one first; where tcs_simbody_bridge is, as in tests,
// the engines are in the program itself.
#pragma once

#include <string>

namespace tcs {

// Sets where libtcs_physics.so is. Called before the first MakeDynamics(), which throws
// DynamicsError if the library cannot be loaded. Not thread-safe; nor is MakeDynamics().
void SetPhysicsLibrary(std::string path);

}  // namespace tcs
