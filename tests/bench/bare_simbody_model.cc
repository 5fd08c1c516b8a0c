#include <memory>

#include "simbody_bridge/simbody/make_integrator.h"
#include "simbody_bridge/simbody/tree/tree.h"
#include "tests/bench/bare_model.h"
#include "tests/bench/physics_world.h"

namespace tcs::bench {

// The tree's own contacts are no part of its system: nothing touches here.
double BareSimbodySeconds(const ModelWork& work) {
  const Forest forest = MakeForest(work.world.models, BareLoads::kTheModel, {});
  SimbodyTree tree(forest, work.world.gravity_mps2);
  BareLoads loads(work);
  std::vector<double> rate(tree.start().size());
  tree.Evaluate(tree.start(), loads.After(0), rate.data());
  const SimTK::System& system = tree.matter().getSystem();
  const auto integrator = MakeIntegrator(work.world.integrator, system);
  integrator->setReturnEveryInternalStep(false);
  integrator->initialize(tree.evaluated());
  const double start_s = CpuSeconds();
  for (int sample = 1; sample <= work.samples; ++sample) {
    const double at_s = sample * work.period.seconds();
    while (integrator->getAdvancedTime() < at_s) integrator->stepTo(at_s, at_s);
    loads.After(sample);  // the tree's forces look there
    integrator->reinitialize(SimTK::Stage::Dynamics, false);
  }
  return CpuSeconds() - start_s;
}

}  // namespace tcs::bench
