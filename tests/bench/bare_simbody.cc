#include "tests/bench/bare_simbody.h"

#include <time.h>

#include <memory>

#include "simbody_bridge/simbody/make_integrator.h"
#include "simbody_bridge/simbody/model.h"
#include "simbody_bridge/simbody/simbody.h"
#include "tests/bench/physics_world.h"

namespace tcs::bench {

double BareSimbodySeconds(int bodies, int samples) {
  const WorldSpec world = PhysicsWorld(bodies);
  std::vector<int> all;
  for (int i = 0; i < bodies; ++i) all.push_back(i);
  const SimbodyModel model(world, all);
  SimTK::State state = model.blank_state();
  for (int i = 0; i < bodies; ++i) {
    model.SetBody(state, i, world.bodies[static_cast<std::size_t>(i)].initial);
  }
  const auto integrator = MakeIntegrator(world.integrator, model.system());
  integrator->setReturnEveryInternalStep(false);
  integrator->initialize(state);
  const double start_s = CpuSeconds();
  for (int sample = 1; sample <= samples; ++sample) {
    const double at_s = sample * kSamplePeriod.seconds();
    while (integrator->getAdvancedTime() < at_s) integrator->stepTo(at_s, at_s);
    for (int i = 0; i < bodies; ++i) {
      model.SetLoad(integrator->updAdvancedState(), i, LoadOf(ChangingWrench(sample)));
    }
    integrator->reinitialize(SimTK::Stage::Dynamics, false);
  }
  return CpuSeconds() - start_s;
}

}  // namespace tcs::bench
