// The air: how it moves, and what it does to a body. See WindSpec and DragSpec for the laws.
#pragma once

#include <array>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/load.h"

namespace tcs {

class Wind {
 public:
  explicit Wind(const WindSpec& spec);

  // The wind's velocity `after_s` from `t` on.
  std::array<double, 3> At(VirtualTime t, double after_s) const;

 private:
  struct Tone {
    double radps;
    std::array<double, 3> phases;  // on each axis
  };
  const std::array<double, 3> mean_mps_;
  double amplitude_mps_ = 0;
  std::vector<Tone> tones_;  // the gusts are their sum
};

// How fast the gusts' fastest tone goes round; 0 without gusts. Error control has to see it.
double FastestGustRadps(const WindSpec& spec);

Load DragOn(const DragSpec& drag, const BodyState& body, const std::array<double, 3>& wind_mps);

}  // namespace tcs
