// The values that the paper reports of its own systems, for comparison: Taylor, Drumwright, Parmer,
// "Making Time Make Sense in Robotic Simulation", section 4.2, trials of 20 s of simulated time.
// Only reports on that scenario show these values.
#pragma once

#include <string_view>

namespace tcs::report::paper {

inline constexpr std::string_view kScenario = "predator_prey";  // how its scenarios' names begin

// The values as the paper writes them; empty where the paper does not say.
struct Values {
  std::string_view system, virtual_time, drift, coordinating, clients, dynamics, overhead;
};

inline constexpr Values kSystems[] = {
    {"the paper: callback", "20 s", "168 s", "", "", "", ""},
    {"the paper: its own system", "20 s", "3 ms", "0.42 s", "20.21 s", "0.59 s", "2 %"},
};

}  // namespace tcs::report::paper
