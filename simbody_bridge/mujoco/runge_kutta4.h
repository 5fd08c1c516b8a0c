// A step of Runge-Kutta 4 as mj_RungeKutta takes it, to the bit; but the caller says how
// accelerations are found.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <functional>
#include <vector>

namespace tcs {

class RungeKutta4 {
 public:
  // `data` has the speeds. Puts these positions into it, and finds its accelerations.
  using Find = std::function<void(const double* positions)>;

  // Of models without activations. `data` is where the step begins, with its accelerations.
  void Step(const mjModel& model, mjData* data, const Find& find);

 private:
  static constexpr int kStages = 4;
  // Memory of Step.
  std::vector<double> start_, positions_, moves_, gains_;
  std::array<std::vector<double>, kStages> speeds_, rates_;
};

}  // namespace tcs
