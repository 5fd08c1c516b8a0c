// The engine-neutral interface to the physics: where bodies are at a time, given the commands until
// then.
//
// Frames and units (REP-103): SI units, right-handed, x forward, y left, z up; quaternions x y z w.
// Positions, orientations, velocities and wrenches are expressed in the world frame unless they say
// otherwise; a body's position is its centre of mass. Ownership: the implementation owns the
// engine; values are copied in and out. Not thread-safe: one thread, the coordinator's, calls it.
//
// Lazy: time is a number, which costs nothing to advance. Bodies are integrated when they are read,
// each island (bodies that can touch or pull each other) by itself.
//
// Determinism: a body's motion is a function of the world, of the commands to the bodies of its
// island, and of the times of the commands that changed something. The motion does not depend on
// how far time was advanced in one go, on what was read and when, on the order of calls, on other
// islands, nor on how much had to be taken back: the same commands give bitwise the same states
// (same build, same kind of processor).
//
// Errors: a violated precondition is a bug of ours and aborts. A world or a wrench without physical
// meaning, or an integration that cannot be completed, throws DynamicsError with one sentence. A
// call that throws has changed nothing. An integration is attempted again by the next Read, and
// succeeds where a command has come in between that keeps the body out of the failure.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "shm/virtual_time.h"
#include "simbody_bridge/model/robot_model.h"

namespace tcs {

struct BodyState {
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_xyzw{0, 0, 0,
                                         1};  // unit length; as an initial value, within 1e-3
  std::array<double, 3> linear_velocity_mps{};
  std::array<double, 3> angular_velocity_radps{};
};

// The force and the torque that a command makes act on a body.
struct Wrench {
  std::array<double, 3> force_n{};  // at the centre of mass
  std::array<double, 3> torque_nm{};
  // Along the body's axes, and turning with them while it acts; else along the world's.
  bool in_body_frame = false;
  // A time constant: the acting wrench w goes from the wrench before to this one, by
  // w' = (this - w) / lag. 0: this one acts at once.
  VirtualDuration lag{};

  bool operator==(const Wrench&) const = default;
};

// The drive of a joint that has one coordinate: effort + stiffness * (position - the joint's
// position) + damping * (velocity - the joint's velocity), and no more than the joint's limit of
// effort either way. N m and radians, or N and metres. A servo is such a drive, evaluated as often
// as the physics are.
struct JointDrive {
  double effort = 0;
  double stiffness = 0;
  double position = 0;
  double damping = 0;
  double velocity = 0;

  bool operator==(const JointDrive&) const = default;
};

struct JointState {
  double position = 0;
  double velocity = 0;
  double effort = 0;  // given by the joint's drive
};

// The state of a link's frame, in the world.
struct LinkState {
  Pose pose;
  std::array<double, 3> linear_velocity_mps{};  // of the frame's origin
  std::array<double, 3> angular_velocity_radps{};
};

// A point where two things touch, and what they do to each other there, in the world's frame. A
// contact stands in a list once: `second` feels the opposite force at the same point.
struct ContactForce {
  int first = 0;  // the link that the force acts on
  // The link that exerts the force, or the fixture (index into WorldSpec::fixtures); the other one
  // of the two is -1. A link that is fixed to the world is never `first`, unless both things are
  // fixed; of two links that move, or of two that do not, `first` has the lower number.
  int second = -1, fixture = -1;
  std::array<double, 3> point_m{};
  std::array<double, 3> normal{};   // of unit length, from the second towards the first
  std::array<double, 3> force_n{};  // along the normal, and friction across it
};

// The axes along which a wrench on a link is given; the link's axes turn with the link while the
// wrench acts.
enum class WrenchFrame { kWorld, kLink };

// The drag of the air on a body that moves through it, whichever way the body is turned: the force
// -(linear + quadratic |v|) v, v being the velocity relative to the wind; the torque of the same
// form against the angular velocity.
struct DragSpec {
  double linear_nspm = 0;
  double quadratic_ns2pm2 = 0;
  double angular_linear_nmsprad = 0;
  double angular_quadratic_nms2prad2 = 0;

  bool operator==(const DragSpec&) const = default;
};

struct BodySpec {
  std::string name;
  double mass_kg = 1.0;
  std::array<double, 3> inertia_kgm2{0.1, 0.1, 0.1};  // principal moments, body frame
  BodyState initial;
  DragSpec drag;
};

// The motion of the air, everywhere alike.
struct WindSpec {
  std::array<double, 3> mean_mps{};
  // Gusts on top of the mean: on each axis of this standard deviation, and correlated over about
  // this time. The gusts are a function of time and the seed.
  double gusts_mps = 0;
  VirtualDuration gust_time = VirtualDuration::Seconds(1);
  std::uint64_t seed = 1;
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
  kMujoco,
};

// Simbody's integrators.
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
  // Steps of this length, counted from the last command that changed something. 0: the engine's own
  // steps: Simbody controls its error by `accuracy`, ODE and MuJoCo take steps of 1 ms. Between the
  // ends of steps of a set length the state is what a step shortened to end there gives; between
  // the ends of steps that the engine chooses, the state is a cubic through both ends and their
  // derivatives.
  VirtualDuration fixed_step{};
  double accuracy = 1e-5;  // relative error of one of Simbody's steps, between 0 and 1

  // For engines that know no other steps than steps of a set length.
  VirtualDuration StepOr(VirtualDuration otherwise) const {
    return fixed_step > VirtualDuration{} ? fixed_step : otherwise;
  }
};

// Gazebo has the same step.
inline constexpr VirtualDuration kOdeStep = VirtualDuration::Milliseconds(1);
inline constexpr VirtualDuration kMujocoStep = VirtualDuration::Milliseconds(1);

struct WorldSpec {
  std::vector<BodySpec> bodies;
  // Models have joints, or touch something: not every engine takes them (engines.h).
  std::vector<RobotModel> models;
  // The things that the models stand on and run into: the floor, walls. They are in the world's
  // frame and do not move. Free bodies touch nothing.
  std::vector<Shape> fixtures;
  std::array<double, 3> gravity_mps2{};
  bool has_region = false;
  RegionSpec region;
  WindSpec wind;  // for bodies with drag
  IntegratorSpec integrator;
  // Bodies (by index) that are integrated as one system. Other bodies are islands of one body each:
  // free bodies cannot touch or pull each other.
  std::vector<std::vector<int>> together;
  // Models (by index) that are one system from the start on, and stay one. Other models that can
  // touch each other are one system for as long as they are near each other.
  std::vector<std::vector<int>> models_together;
};

class DynamicsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// An interruption was asked for (Dynamics::InterruptBy).
class DynamicsInterrupted : public DynamicsError {
 public:
  DynamicsInterrupted() : DynamicsError("the integration was interrupted") {}
};

class Dynamics {
 public:
  // A saved state; restore it into the Dynamics it came from, any number of times.
  class Checkpoint {
   public:
    virtual ~Checkpoint() = default;
  };

  // The work since the beginning, including the work that was taken back.
  struct Work {
    std::int64_t steps = 0;       // of the engine
    std::int64_t changes = 0;     // steps that began with other wrenches than the one before ended
    std::int64_t taken_back = 0;  // commands that changed what had been integrated already
    std::int64_t regrouped = 0;   // times that models near each other were looked for anew
    std::int64_t helped = 0;      // pieces of work that were done on other processors
  };

  virtual ~Dynamics() = default;

  // Islands may be integrated on these processors of the host, too, beside the caller's: threads of
  // this process help where it is worth waking them. Their help changes no state, to the bit.
  virtual void UseProcessors(std::span<const int> cpus) = 0;

  // Looks at `asked` now and then while it integrates, and throws DynamicsInterrupted where that
  // is true. Threads that help ask, too.
  virtual void InterruptBy(const std::function<bool()>& asked) = 0;

  // How many systems bodies and models are divided into; where models come near each other and
  // part, as late as they have been integrated.
  virtual int island_count() const = 0;

  // No command for an earlier time comes any more, nor is an earlier state read.
  virtual VirtualTime Now() const = 0;
  // Advances to `t` >= Now(). Integrates nothing.
  virtual void AdvanceTo(VirtualTime t) = 0;

  // From `t` >= Now() on, `wrench` acts on body `body` (index into WorldSpec::bodies) until a later
  // command replaces it. Commands for one instant apply in the order they were given; the last one
  // stays. States that were read for later times were read as if this command had not been given. A
  // command that leaves things as they are costs nothing.
  virtual void Apply(int body, const Wrench& wrench, VirtualTime t) = 0;

  // The states of `bodies` at `t` >= Now(), given the commands so far; `states` has as many
  // elements. A command for `t` itself does not change them. Reading many at once is faster than
  // one by one.
  virtual void Read(VirtualTime t, std::span<const int> bodies, std::span<BodyState> states) = 0;
  // The state of one body at Now().
  BodyState Read(int body) {
    BodyState state;
    Read(Now(), {&body, 1}, {&state, 1});
    return state;
  }

  // The models' links, joints and rotors by index: the first model's in its own order, then the
  // next model's. Names are resolved once; none: there is no such part.
  virtual std::optional<int> FindLink(std::string_view model, std::string_view link) const = 0;
  virtual std::optional<int> FindJoint(std::string_view model, std::string_view joint) const = 0;
  virtual std::optional<int> FindRotor(std::string_view model, std::string_view rotor) const = 0;

  // As Apply, for links, joints and rotors. A wrench on a link acts at the origin of its frame; a
  // wrench along the world's axes and a wrench along the link's axes act beside each other. A joint
  // that is driven has one coordinate and mimics none. A rotor's speed is within what the rotor can
  // do.
  virtual void ApplyToLink(int link, WrenchFrame frame, const Wrench& wrench, VirtualTime t) = 0;
  virtual void Drive(int joint, const JointDrive& drive, VirtualTime t) = 0;
  virtual void Spin(int rotor, double speed_radps, VirtualTime t) = 0;

  // As Read, for links and for joints, which have one coordinate or are fixed.
  virtual void ReadLinks(VirtualTime t, std::span<const int> links,
                         std::span<LinkState> states) = 0;
  virtual void ReadJoints(VirtualTime t, std::span<const int> joints,
                          std::span<JointState> states) = 0;

  // The contacts of all models at `t` >= Now(), only contacts that push: in the order of their
  // first and then of their second things, fixtures after links. A force is that of the engine's
  // step which ends at `t` or is under way then, constant over it: so it is what changed the
  // momenta that ReadLinks tells of at `t`, by commands until then. A blow counts in the steps that
  // it takes (of 1 ms, by default). At the run's start no step has been taken, and nothing pushes.
  // Free bodies touch nothing, on any engine; the walls of a region are no contacts.
  //
  // As Read, ReadContacts changes nothing. The call costs each island that may touch something
  // about a step.
  virtual void ReadContacts(VirtualTime t, std::vector<ContactForce>* contacts) = 0;

  // A checkpoint holds the state that a run goes on from: after Restore the same calls compute
  // bitwise what they computed in the run that was saved. A checkpoint costs less than a step. With
  // `reuse`, an earlier checkpoint of this Dynamics, its memory is used again.
  virtual std::unique_ptr<Checkpoint> Save(std::unique_ptr<Checkpoint> reuse) = 0;
  std::unique_ptr<Checkpoint> Save() { return Save(nullptr); }
  virtual void Restore(const Checkpoint& checkpoint) = 0;

  virtual const Work& work() const = 0;
};

// The dynamics on the engine that world.integrator names. Throws DynamicsError for a world that the
// engine refuses.
std::unique_ptr<Dynamics> MakeDynamics(const WorldSpec& world);

}  // namespace tcs
