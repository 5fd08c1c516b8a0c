#include "examples/predator_prey/prey_controller/flee_or_wander.h"

#include <cmath>

namespace predator_prey {

FleeOrWander::FleeOrWander(const PreyOptions& options) : options_(options), random_(options.seed) {
  DrawWanderForce();
}

void FleeOrWander::DrawWanderForce() {
  const double per_axis_n = options_.wander_force_n / std::sqrt(3.0);
  for (double& axis : wander_force_n_) axis = per_axis_n * normal_(random_);
  wander_left_s_ += options_.wander_hold_s;
}

Eigen::Vector3d FleeOrWander::Step(double elapsed_s, const BodyState& prey,
                                   const BodyState& predator) {
  // The walk goes on unseen during flight, so it depends on the seed and the time alone.
  wander_left_s_ -= elapsed_s;
  while (wander_left_s_ < 1e-9) DrawWanderForce();

  const Eigen::Vector3d away = prey.position_m - predator.position_m;
  if (away.norm() < options_.flee_distance_m) return options_.flee_force_n * away.normalized();
  return wander_force_n_;
}

}  // namespace predator_prey
