#include "simbody_bridge/simbody/make_integrator.h"

namespace tcs {
namespace {

std::shared_ptr<SimTK::Integrator> MakeMethod(IntegratorKind kind, const SimTK::System& system) {
  switch (kind) {
    case IntegratorKind::kRungeKutta3:
      return std::make_shared<SimTK::RungeKutta3Integrator>(system);
    case IntegratorKind::kRungeKuttaMerson:
      return std::make_shared<SimTK::RungeKuttaMersonIntegrator>(system);
    case IntegratorKind::kVerlet:
      return std::make_shared<SimTK::VerletIntegrator>(system);
    case IntegratorKind::kSemiExplicitEuler2:
      return std::make_shared<SimTK::SemiExplicitEuler2Integrator>(system);
    case IntegratorKind::kExplicitEuler:
      return std::make_shared<SimTK::ExplicitEulerIntegrator>(system);
  }
  throw DynamicsError("integrator: unknown kind");
}

}  // namespace

std::shared_ptr<SimTK::Integrator> MakeIntegrator(const IntegratorSpec& spec,
                                                  const SimTK::System& system) {
  auto integrator = MakeMethod(spec.kind, system);
  integrator->setAccuracy(spec.accuracy);
  integrator->setReturnEveryInternalStep(true);
  if (spec.fixed_step > VirtualDuration{}) {
    // Twice the step: the stops alone decide the lengths, exact in nanoseconds. With the step
    // itself the rounding of seconds would now and then leave a sliver that costs a step of its
    // own.
    integrator->setFixedStepSize(2 * spec.fixed_step.seconds());
  }
  return integrator;
}

}  // namespace tcs
