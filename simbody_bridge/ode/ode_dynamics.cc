// Dynamics on ODE: semi-implicit Euler by fixed steps, the last one before a stop shortened so that
// it ends there. A stop is an AdvanceTo target or the time of a command.
#include "simbody_bridge/ode/ode_dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "simbody_bridge/command_queue.h"
#include "simbody_bridge/ode/ode_library.h"
#include "simbody_bridge/ode/ode_world.h"
#include "simbody_bridge/require.h"
#include "simbody_bridge/world_check.h"

namespace tcs {
namespace {

// All that a run goes on from.
struct Present {
  VirtualTime now;
  std::vector<BodyState> states;
  std::vector<Wrench> wrenches;  // acting
  CommandQueue commands;
};

struct OdeCheckpoint : Dynamics::Checkpoint {
  const void* origin = nullptr;
  Present present;
};

BodyState Normalised(BodyState state) {
  auto& q = state.orientation_xyzw;
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& component : q) component /= norm;
  return state;
}

class OdeDynamics : public Dynamics {
 public:
  explicit OdeDynamics(const WorldSpec& world)
      : world_(world),
        step_(world.integrator.fixed_step > VirtualDuration{} ? world.integrator.fixed_step
                                                              : kOdeStep) {
    for (const BodySpec& body : world.bodies) {
      names_.push_back(body.name);
      present_.states.push_back(Normalised(body.initial));
    }
    present_.wrenches.resize(names_.size());
  }

  VirtualTime Now() const override { return present_.now; }
  void AdvanceTo(VirtualTime t) override;
  void Apply(int body, const Wrench& wrench, VirtualTime t) override;
  BodyState Read(int body) const override;
  std::unique_ptr<Checkpoint> Save() override;
  void Restore(const Checkpoint& checkpoint) override;

 private:
  void RequireBody(int body) const;
  void ApplyDueCommands();
  void StepTo(VirtualTime stop);
  void CheckStateIsFinite() const;

  OdeWorld world_;
  const VirtualDuration step_;
  std::vector<std::string> names_;
  Present present_;
};

void OdeDynamics::AdvanceTo(VirtualTime t) {
  Require(t >= Now() && !t.IsNever(), "the dynamics can only advance to a later, finite time");
  while (Now() < t) {
    ApplyDueCommands();
    StepTo(std::min({t, present_.commands.NextTime(), Now() + step_}));
    CheckStateIsFinite();
  }
}

// On leaving an instant, not on reaching it: commands for it may be given until then.
void OdeDynamics::ApplyDueCommands() {
  while (const auto command = present_.commands.TakeDue(Now())) {
    present_.wrenches[static_cast<std::size_t>(command->body)] = command->wrench;
  }
}

void OdeDynamics::StepTo(VirtualTime stop) {
  world_.Step((stop - Now()).seconds(), present_.wrenches, &present_.states);
  present_.now = stop;
}

void OdeDynamics::CheckStateIsFinite() const {
  for (std::size_t body = 0; body < names_.size(); ++body) {
    if (AllFinite(present_.states[body])) continue;
    throw DynamicsError(fmt::format("body '{}': its motion has diverged by {:.12g} s", names_[body],
                                    Now().seconds()));
  }
}

void OdeDynamics::RequireBody(int body) const {
  Require(body >= 0 && body < static_cast<int>(names_.size()), "no such body in the dynamics");
}

void OdeDynamics::Apply(int body, const Wrench& wrench, VirtualTime t) {
  RequireBody(body);
  Require(t >= Now() && !t.IsNever(), "a command cannot act before the dynamics' present");
  CheckWrench(names_[static_cast<std::size_t>(body)], wrench);
  present_.commands.Add(t, {body, wrench});
}

BodyState OdeDynamics::Read(int body) const {
  RequireBody(body);
  return present_.states[static_cast<std::size_t>(body)];
}

std::unique_ptr<Dynamics::Checkpoint> OdeDynamics::Save() {
  auto checkpoint = std::make_unique<OdeCheckpoint>();
  checkpoint->origin = this;
  checkpoint->present = present_;
  return checkpoint;
}

void OdeDynamics::Restore(const Checkpoint& checkpoint) {
  const auto* saved = dynamic_cast<const OdeCheckpoint*>(&checkpoint);
  Require(saved != nullptr && saved->origin == this,
          "a checkpoint belongs to the dynamics that saved it");
  present_ = saved->present;
}

}  // namespace

std::unique_ptr<Dynamics> MakeOdeDynamics(const WorldSpec& world) {
  OpenOde();
  return std::make_unique<OdeDynamics>(world);
}

}  // namespace tcs
