// The engine-neutral interface to the physics: a leaf of the scheduler tree that moves only when it
// is told to.
//
// Frames and units (REP-103): SI units, right-handed, x forward, y left, z up; quaternions x y z w.
// Positions, orientations, velocities and wrenches are expressed in the world frame; a body's
// position is its centre of mass. Ownership: the implementation owns the engine; values are copied
// in and out. Not thread-safe: one thread, the coordinator's, calls it.
//
// Errors: a violated precondition is a bug of ours and aborts. A world or a wrench without physical
// meaning, or an integration that cannot be completed, throws DynamicsError with one sentence. An
// integration fails where it is done: in AdvanceTo, or when somebody looks at what came of it.
// After that only Restore and destruction are meaningful; any other call that throws has changed
// nothing.
//
// Determinism: what becomes of a body depends on the commands to it and to what can touch it, on
// their times, and on the times at which it was read: the same ones give bitwise the same states
// (same build, same kind of processor). Where AdvanceTo has stopped on the way is not among them. A
// reading ends an integration step, so other readings give states that differ within the
// integrator's accuracy.
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
  std::array<double, 4> orientation_xyzw{0, 0, 0,
                                         1};  // unit length; as an initial value, within 1e-3
  std::array<double, 3> linear_velocity_mps{};
  std::array<double, 3> angular_velocity_radps{};
};

struct Wrench {
  std::array<double, 3> force_n{};  // at the centre of mass
  std::array<double, 3> torque_nm{};
};

struct BodySpec {
  std::string name;
  double mass_kg = 1.0;
  std::array<double, 3> inertia_kgm2{0.1, 0.1, 0.1};  // principal moments, body frame
  BodyState initial;
};

// A cube around the origin whose walls push back. Per axis, a body whose centre is outside, |x| >
// half_extent, is pushed inwards with stiffness * penetration + damping * outward velocity, but
// never pulled outwards.
struct RegionSpec {
  double half_extent_m = 10.0;
  double stiffness_npm = 50.0;
  double damping_nspm = 0.0;
};

enum class EngineKind {
  kSimbody,
  kOde,
};

// Simbody's.
enum class IntegratorKind {
  kRungeKutta3,
  kRungeKuttaMerson,
  kVerlet,
  kSemiExplicitEuler2,
  kExplicitEuler,
};

// Which engine moves the bodies, and by which steps.
struct IntegratorSpec {
  EngineKind engine = EngineKind::kSimbody;
  IntegratorKind kind = IntegratorKind::kRungeKutta3;  // Simbody alone has a choice
  // Steps of this length, counted from the last stop (an AdvanceTo target or the time of a
  // command); the last step before a stop is shorter where the length does not fit. 0: what the
  // engine does by itself: Simbody controls its error by `accuracy`, ODE takes kOdeStep.
  VirtualDuration fixed_step{};
  double accuracy = 1e-3;  // relative error of one of Simbody's steps, between 0 and 1
};

// Gazebo's, too.
inline constexpr VirtualDuration kOdeStep = VirtualDuration::Milliseconds(1);

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

  // Time passes to `t` >= Now(). What that does to bodies is computed then or when they are read,
  // never beyond `t`, in pieces at the times of pending commands.
  virtual void AdvanceTo(VirtualTime t) = 0;

  // From `t` >= Now() on, `wrench` acts on body `body` (index into WorldSpec::bodies) until a later
  // command replaces it. Commands for one instant apply in the order they were given; the last one
  // stays. A command for Now() acts from the next AdvanceTo on and does not change what Read says.
  virtual void Apply(int body, const Wrench& wrench, VirtualTime t) = 0;

  // The state at Now().
  virtual BodyState Read(int body) const = 0;

  // A checkpoint holds the state, the acting wrenches, the pending commands and, of an engine that
  // chooses its steps, the next one's size: after Restore the same calls compute bitwise what they
  // computed in the run that was saved, with every integrator, fixed or error-controlled, and also
  // after an AdvanceTo that threw.
  virtual std::unique_ptr<Checkpoint> Save() = 0;
  virtual void Restore(const Checkpoint& checkpoint) = 0;
};

// On the engine that world.integrator names; bodies that cannot touch or pull each other are
// integrated apart (islands.h). Throws DynamicsError for a world that it refuses.
std::unique_ptr<Dynamics> MakeDynamics(const WorldSpec& world);

}  // namespace tcs
