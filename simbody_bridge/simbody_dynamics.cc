// Dynamics on Simbody. Virtual time is kept here, in nanoseconds; Simbody's own time, in seconds,
// is always that of the last stop. A stop is an AdvanceTo target, the time of a command or the end
// of a fixed step, and the integrator is never allowed beyond the next one, so there is nothing to
// take back when a command arrives.
#include "simbody_bridge/simbody_dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "simbody_bridge/command_queue.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/make_integrator.h"
#include "simbody_bridge/require.h"
#include "simbody_bridge/simbody.h"
#include "simbody_bridge/simbody_model.h"
#include "simbody_bridge/world_check.h"

namespace tcs {
namespace {

// Simbody's messages run over several lines.
std::string OnOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// What the integrator needs to go on exactly as it would have, whatever it has done since: all of
// Simbody's state that varies in such a world, and the one thing that an integrator remembers
// outside of it.
struct SimbodyCheckpoint : Dynamics::Checkpoint {
  const void* origin = nullptr;
  VirtualTime now;
  CommandQueue commands;
  SimTK::Vector continuous_state;
  SimTK::Vector_<SimTK::SpatialVec> wrenches;
  double next_step_s = 0;
};

class SimbodyDynamics : public Dynamics {
 public:
  explicit SimbodyDynamics(const WorldSpec& world)
      : model_(world),
        integrator_(MakeIntegrator(world.integrator, model_.system())),
        fixed_step_(world.integrator.fixed_step) {
    for (const BodySpec& body : world.bodies) body_names_.push_back(body.name);
    integrator_->initialize(model_.initial_state());
  }

  VirtualTime Now() const override { return now_; }
  void AdvanceTo(VirtualTime t) override;
  void Apply(int body, const Wrench& wrench, VirtualTime t) override;
  BodyState Read(int body) const override;
  std::unique_ptr<Checkpoint> Save() override;
  void Restore(const Checkpoint& checkpoint) override;

 private:
  bool HasFixedStep() const { return fixed_step_ > VirtualDuration{}; }
  void RequireBody(int body) const;
  void ApplyDueCommands();
  VirtualTime NextStop(VirtualTime target) const;
  void IntegrateTo(VirtualTime stop);
  void StepTo(double stop_s);
  void CheckStateIsFinite() const;

  SimbodyModel model_;
  std::shared_ptr<SimTK::Integrator> integrator_;
  const VirtualDuration fixed_step_;
  std::vector<std::string> body_names_;
  CommandQueue commands_;
  VirtualTime now_;
};

void SimbodyDynamics::AdvanceTo(VirtualTime t) {
  Require(t >= now_ && !t.IsNever(), "the dynamics can only advance to a later, finite time");
  while (now_ < t) {
    ApplyDueCommands();
    IntegrateTo(NextStop(t));
    CheckStateIsFinite();
  }
}

VirtualTime SimbodyDynamics::NextStop(VirtualTime target) const {
  const VirtualTime stop = std::min(target, commands_.NextTime());
  return HasFixedStep() ? std::min(stop, now_ + fixed_step_) : stop;
}

// On leaving an instant, not on reaching it: commands for it may be given until then.
void SimbodyDynamics::ApplyDueCommands() {
  bool changed = false;
  while (const auto command = commands_.TakeDue(now_)) {
    model_.SetWrench(integrator_->updAdvancedState(), command->body, command->wrench);
    changed = true;
  }
  if (changed) integrator_->reinitialize(SimTK::Stage::Dynamics, false);
}

void SimbodyDynamics::IntegrateTo(VirtualTime stop) {
  try {
    StepTo(stop.seconds());
  } catch (const std::exception& e) {
    throw DynamicsError(fmt::format("the integration from {:.12g} s to {:.12g} s failed: {}",
                                    now_.seconds(), stop.seconds(), OnOneLine(e.what())));
  }
  now_ = stop;
}

// stepTo's second argument is the limit that Simbody does not pass; with the first alone it would
// run ahead and interpolate. Both times come from nanoseconds by the same multiplication, and
// Simbody lands on the time it is asked for: comparing them exactly is sound. Stops that have
// become the same double (after 97 days) need no step.
void SimbodyDynamics::StepTo(double stop_s) {
  while (integrator_->getAdvancedTime() < stop_s) {
    const double before_s = integrator_->getAdvancedTime();
    const auto status = integrator_->stepTo(stop_s, stop_s);
    const bool stalled = integrator_->getAdvancedTime() == before_s &&
                         status != SimTK::Integrator::StartOfContinuousInterval;
    if (stalled) throw DynamicsError("the integrator makes no progress");
  }
}

// With fixed steps Simbody takes whatever comes out of a step, and stumbles over it only in the
// next one.
void SimbodyDynamics::CheckStateIsFinite() const {
  for (int body = 0; body < model_.body_count(); ++body) {
    if (!AllFinite(Read(body))) {
      throw DynamicsError(fmt::format("body '{}': its motion has diverged by {:.12g} s",
                                      body_names_[body], now_.seconds()));
    }
  }
}

void SimbodyDynamics::RequireBody(int body) const {
  Require(body >= 0 && body < model_.body_count(), "no such body in the dynamics");
}

void SimbodyDynamics::Apply(int body, const Wrench& wrench, VirtualTime t) {
  RequireBody(body);
  Require(t >= now_ && !t.IsNever(), "a command cannot act before the dynamics' present");
  CheckWrench(body_names_[body], wrench);
  commands_.Add(t, {body, wrench});
}

BodyState SimbodyDynamics::Read(int body) const {
  RequireBody(body);
  return model_.ReadBody(integrator_->getAdvancedState(), body);
}

std::unique_ptr<Dynamics::Checkpoint> SimbodyDynamics::Save() {
  const SimTK::State& state = integrator_->getAdvancedState();
  auto checkpoint = std::make_unique<SimbodyCheckpoint>();
  checkpoint->origin = this;
  checkpoint->now = now_;
  checkpoint->commands = commands_;
  checkpoint->continuous_state = state.getY();
  checkpoint->wrenches = model_.wrenches().getAllBodyForces(state);
  checkpoint->next_step_s = integrator_->getPredictedNextStepSize();
  return checkpoint;
}

void SimbodyDynamics::Restore(const Checkpoint& checkpoint) {
  const auto* saved = dynamic_cast<const SimbodyCheckpoint*>(&checkpoint);
  Require(saved && saved->origin == this, "a checkpoint belongs to the dynamics that saved it");
  SimTK::State state = model_.initial_state();
  state.setTime(saved->now.seconds());
  state.setY(saved->continuous_state);
  model_.wrenches().setAllBodyForces(state, saved->wrenches);
  if (!HasFixedStep()) integrator_->setInitialStepSize(saved->next_step_s);
  integrator_->initialize(state);
  // initialize() normalises quaternions, which the run that was saved did not do at this instant.
  integrator_->updAdvancedState().setY(saved->continuous_state);
  now_ = saved->now;
  commands_ = saved->commands;
}

}  // namespace

std::unique_ptr<Dynamics> MakeSimbodyDynamics(const WorldSpec& world) {
  try {
    return std::make_unique<SimbodyDynamics>(world);
  } catch (const DynamicsError&) {
    throw;
  } catch (const std::exception& e) {
    throw DynamicsError("Simbody refuses the world: " + OnOneLine(e.what()));
  }
}

}  // namespace tcs
