// The prey's behaviour: straight away from a predator that is near, else a random walk.
#pragma once

#include <cstdint>
#include <random>

#include "examples/predator_prey/common/body_state.h"

namespace predator_prey {

struct PreyOptions {
  double flee_distance_m = 5.0;
  double flee_force_n = 3.0;
  double wander_force_n = 1.0;  // root mean square of the random force's magnitude
  double wander_hold_s = 0.5;   // each random force is held for so long
  std::uint64_t seed = 1;
};

class FleeOrWander {
 public:
  explicit FleeOrWander(const PreyOptions& options);

  // The force to apply `elapsed_s` after the last call.
  Eigen::Vector3d Step(double elapsed_s, const BodyState& prey, const BodyState& predator);

 private:
  void DrawWanderForce();

  PreyOptions options_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Eigen::Vector3d wander_force_n_;
  double wander_left_s_ = 0.0;
};

}  // namespace predator_prey
