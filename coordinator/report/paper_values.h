// What the paper reports of its own systems, for comparison: M. Taylor, E. Drumwright, G. Parmer,
// "Making Time Make Sense in Robotic Simulation", section 4.2, trials of 20 s of simulated time.
// Only reports on that scenario show them.
#pragma once

#include <string_view>

namespace tcs::report::paper {

inline constexpr std::string_view kScenario = "predator_prey";  // how its scenarios' names begin

struct Values {
  std::string_view system;
  double drift_s;
  // Negative: the paper does not say.
  double coordinating_s, clients_s, dynamics_s, overhead;
};

inline constexpr Values kSystems[] = {
    {"the paper: callback", 168.0, -1, -1, -1, -1},
    {"the paper: its own system", 0.003, 0.42, 20.21, 0.59, 0.02},
};

}  // namespace tcs::report::paper
