// Simbody's integrator for an IntegratorSpec.
#pragma once

#include <memory>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

// The integrator is not yet initialised, and returns after each step. `system` must outlive it.
// With a fixed step the integrator takes one step to whatever stop it is given, so the stops must
// be no more than a fixed step apart; else it chooses its steps by `spec.accuracy`. Shared only in
// type: ~Integrator is not virtual, and a shared_ptr remembers which destructor to call.
std::shared_ptr<SimTK::Integrator> MakeIntegrator(const IntegratorSpec& spec,
                                                  const SimTK::System& system);

}  // namespace tcs
