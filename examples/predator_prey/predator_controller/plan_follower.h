// Executes the beginning of a plan: the plan's own control, plus feedback onto the trajectory that
// the plan expects.
#pragma once

#include <optional>
#include <vector>

#include "examples/predator_prey/common/plan.h"

namespace predator_prey {

struct FollowerOptions {
  double execute_s = 0.1;  // no plan is executed for longer
  double period_s = 0.01;  // how long each control will be held
  // Feedback accelerations; they act on orientation and rotation as on position and velocity.
  double kp_per_s2 = 5.0;
  double kd_per_s = 4.0;
  double mass_kg = 1.0;
  double inertia_kgm2 = 0.1;
  double max_force_n = 10.0;  // per axis, as for the torque
  double max_torque_nm = 0.1;
};

// `time_s` is the caller's clock, the same in all calls.
class PlanFollower {
 public:
  explicit PlanFollower(const FollowerOptions& options) : options_(options) {}

  // Replaces the plan; it is executed from its beginning, from `time_s` on.
  void Start(std::vector<PlanStep> plan, double time_s);

  // The wrench to apply from `time_s` on; nothing when the plan is used up.
  std::optional<Wrench> Control(double time_s, const BodyState& actual) const;

 private:
  Wrench Track(const PlanStep& step, const BodyState& actual) const;

  FollowerOptions options_;
  std::vector<PlanStep> plan_;
  double started_s_ = 0.0;
};

}  // namespace predator_prey
