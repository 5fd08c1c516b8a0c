// The one place that knows all engines.
#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/ode/ode_engine.h"
#include "simbody_bridge/simbody/simbody_engine.h"

namespace tcs {

std::unique_ptr<IslandEngine> MakeEngine(const WorldSpec& world,
                                         const std::vector<std::vector<int>>& islands) {
  switch (world.integrator.engine) {
    case EngineKind::kSimbody:
      return MakeSimbodyEngine(world, islands);
    case EngineKind::kOde:
      return MakeOdeEngine(world, islands);
  }
  throw DynamicsError("engine: unknown kind");
}

}  // namespace tcs
