// The engine-neutral interface to the physics: a leaf of the scheduler tree that moves only when it is told to.
//
// Frames and units (REP-103): SI units, right-handed, x forward, y left, z up; quaternions x y z w. Positions,
// orientations, velocities and wrenches are expressed in the world frame; a body's position is its centre of mass.
// Ownership: the implementation owns the engine; values are copied in and out. Not thread-safe: one thread, the
// coordinator's, calls it. Errors: a violated precondition is a bug of ours and aborts; an integration that the
// engine cannot complete throws DynamicsError with one sentence.
#pragma once

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "shm/virtual_time.h"

namespace tcs {

struct BodyState {
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_xyzw{0, 0, 0, 1};
  std::array<double, 3> linear_velocity_mps{};
  std::array<double, 3> angular_velocity_radps{};
};

struct Wrench {
  std::array<double, 3> force_n{};    // at the centre of mass
  std::array<double, 3> torque_nm{};
};

struct BodySpec {
  std::string name;
  double mass_kg = 1.0;
  std::array<double, 3> inertia_kgm2{0.1, 0.1, 0.1};  // principal moments, body frame
  BodyState initial;
};

// A cube around the origin whose walls push back: outside |x| > half_extent the force is
// stiffness * penetration - damping * outward velocity, per axis, never pulling.
struct RegionSpec {
  double half_extent_m = 10.0;
  double stiffness_npm = 50.0;
  double damping_nspm = 0.0;
};

enum class IntegratorKind {
  kRungeKutta3,
  kRungeKuttaMerson,
  kVerlet,
  kSemiExplicitEuler2,
  kExplicitEuler,
};

struct IntegratorSpec {
  IntegratorKind kind = IntegratorKind::kRungeKutta3;
  // Fixed steps of this length; 0 means error-controlled with `accuracy`.
  VirtualDuration fixed_step{};
  double accuracy = 1e-3;
};

struct WorldSpec {
  std::vector<BodySpec> bodies;
  std::array<double, 3> gravity_mps2{};
  bool has_region = false;
  RegionSpec region;
  IntegratorSpec integrator;
};

class DynamicsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Dynamics {
 public:
  // An engine's saved state; restore it into the Dynamics it came from, any number of times.
  class Checkpoint {
   public:
    virtual ~Checkpoint() = default;
  };

  virtual ~Dynamics() = default;

  virtual VirtualTime Now() const = 0;

  // Integrates to exactly `t` >= Now(), in pieces at the times of pending commands.
  virtual void AdvanceTo(VirtualTime t) = 0;

  // From `t` >= Now() on, `wrench` acts on body `body` (index into WorldSpec::bodies) until a later command
  // replaces it. Commands for one instant apply in the order they were given; the last one stays.
  virtual void Apply(int body, const Wrench& wrench, VirtualTime t) = 0;

  // The state at Now().
  virtual BodyState Read(int body) const = 0;

  // Replays from a checkpoint repeat bitwise; saving must not change what the run itself goes on to compute.
  virtual std::unique_ptr<Checkpoint> Save() = 0;
  virtual void Restore(const Checkpoint& checkpoint) = 0;
};

// Simbody behind the interface. Throws DynamicsError for a world that Simbody refuses.
std::unique_ptr<Dynamics> MakeSimbodyDynamics(const WorldSpec& world);

}  // namespace tcs
