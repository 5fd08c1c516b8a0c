// A world as Simbody knows it: what does not change while time advances. All state is in
// SimTK::State objects, which the functions below read and write.
#pragma once

#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/simbody.h"

namespace tcs {

class SimbodyModel {
 public:
  // `world` has passed CheckWorld. Throws what Simbody throws if it still refuses it.
  explicit SimbodyModel(const WorldSpec& world);
  SimbodyModel(const SimbodyModel&) = delete;
  SimbodyModel& operator=(const SimbodyModel&) = delete;

  const SimTK::System& system() const { return system_; }
  const SimTK::Force::DiscreteForces& wrenches() const { return wrenches_; }
  const SimTK::State& initial_state() const { return initial_state_; }
  int body_count() const { return static_cast<int>(bodies_.size()); }

  BodyState ReadBody(const SimTK::State& state, int body) const;
  void SetWrench(SimTK::State& state, int body, const Wrench& wrench) const;

 private:
  void AddBody(const BodySpec& body);
  void SetBody(SimTK::State& state, int body, const BodyState& value) const;

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::GeneralForceSubsystem forces_{system_};
  SimTK::Force::DiscreteForces wrenches_{forces_, matter_};
  std::vector<SimTK::MobilizedBody::Free> bodies_;
  SimTK::State initial_state_;
};

}  // namespace tcs
