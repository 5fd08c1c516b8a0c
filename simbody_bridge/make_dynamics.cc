// The one place that knows all engines.
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/ode/ode_dynamics.h"
#include "simbody_bridge/simbody_dynamics.h"
#include "simbody_bridge/world_check.h"

namespace tcs {

std::unique_ptr<Dynamics> MakeDynamics(const WorldSpec& world) {
  CheckWorld(world);
  switch (world.integrator.engine) {
    case EngineKind::kSimbody:
      return MakeSimbodyDynamics(world);
    case EngineKind::kOde:
      return MakeOdeDynamics(world);
  }
  throw DynamicsError("engine: unknown kind");
}

}  // namespace tcs
