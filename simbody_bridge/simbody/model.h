// An island as Simbody knows it: the part that does not change while time advances. All state is in
// SimTK::State objects, or in their continuous part alone, an array of all coordinates and then all
// speeds.
#pragma once

#include <span>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/load.h"
#include "simbody_bridge/simbody/simbody.h"
#include "simbody_bridge/simbody/varying_force.h"

namespace tcs {

// Of a free body: a quaternion and a position, an angular and a linear velocity.
inline constexpr std::size_t kFreeBodyCoordinates = 7, kFreeBodySpeeds = 6, kFreeBodyNumbers = 13;

class SimbodyModel {
 public:
  // A model with the world's bodies of these indices. `world` has passed CheckWorld. Throws what
  // Simbody throws if it still refuses the world.
  SimbodyModel(const WorldSpec& world, const std::vector<int>& bodies);
  SimbodyModel(const SimbodyModel&) = delete;
  SimbodyModel& operator=(const SimbodyModel&) = delete;

  const SimTK::System& system() const { return system_; }
  int body_count() const { return static_cast<int>(bodies_.size()); }

  // A state of the system, in which nothing of the bodies is set yet.
  const SimTK::State& blank_state() const { return blank_state_; }
  void SetBody(SimTK::State& state, int body, const BodyState& value) const;
  // Sets the load on the body, beside the load that varies in the course of a step.
  void SetLoad(SimTK::State& state, int body, const Load& load) const;
  // See VaryingForce: for states that are evaluated from now on, whosever they are.
  void SetStep(const Loads& loads, const IslandStep& step) const { varying_->Set(loads, step); }

 private:
  void AddBody(const BodySpec& body);

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::GeneralForceSubsystem forces_{system_};
  SimTK::Force::DiscreteForces loads_{forces_, matter_};
  std::vector<SimTK::MobilizedBody::Free> bodies_;
  VaryingForce* varying_ = nullptr;  // Simbody owns it
  SimTK::State blank_state_;
};

// The state of a body in the continuous part of a state of `body_count` free bodies.
BodyState ReadBody(std::span<const double> continuous, int body_count, int body);
void WriteBody(const BodyState& value, int body_count, int body, std::span<double> continuous);
// Makes the orientations' quaternions unit length again.
void NormaliseQuaternions(std::span<double> continuous, int body_count);

}  // namespace tcs
