#include "simbody_bridge/simbody/simbody_engine.h"

#include "simbody_bridge/one_line.h"
#include "simbody_bridge/simbody/integrator_engine.h"
#include "simbody_bridge/simbody/lanes_engine.h"
#include "simbody_bridge/simbody/steps.h"

namespace tcs {

std::unique_ptr<BodyEngine> MakeSimbodyEngine(const WorldSpec& world,
                                              const std::vector<std::vector<int>>& islands) {
  const IntegratorSpec& integrator = world.integrator;
  const bool has_set_steps = integrator.fixed_step > VirtualDuration{};
  try {
    if (integrator.kind == IntegratorKind::kRungeKutta3 && !has_set_steps) {
      return MakeLanesEngine(world, islands);
    }
    return MakeIntegratorEngine(world, islands);
  } catch (const DynamicsError&) {
    throw;
  } catch (const std::exception& e) {
    throw DynamicsError("Simbody refuses the world: " + OnOneLine(e.what()));
  }
}

}  // namespace tcs
