#include "simbody_bridge/make_engine.h"

#include "simbody_bridge/ode/ode_dynamics.h"
#include "simbody_bridge/simbody_dynamics.h"

namespace tcs {

std::unique_ptr<Dynamics> MakeEngine(const WorldSpec& world) {
  switch (world.integrator.engine) {
    case EngineKind::kSimbody:
      return MakeSimbodyDynamics(world);
    case EngineKind::kOde:
      return MakeOdeDynamics(world);
  }
  throw DynamicsError("engine: unknown kind");
}

}  // namespace tcs
