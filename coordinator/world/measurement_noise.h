// What is wrong with what a sensor of a robot measures: noise and bias.
//
// Pure. What happens to a sample depends on the sensor's seed and the sample's number alone.
#pragma once

#include <array>
#include <cstdint>

#include "coordinator/scenario/scenario.h"
#include "simbody_bridge/measurements.h"

namespace tcs {

class MeasurementNoise {
 public:
  MeasurementNoise() = default;
  MeasurementNoise(const MeasurementErrors& errors, std::uint64_t seed);

  // Adds what is wrong with the sample of that number, of the same number always the same, and says
  // how much that may be. A bias that is known does not count there.
  void Disturb(std::uint64_t sample, Measurement* measurement) const;

 private:
  class Draws;

  MeasurementErrors errors_{};
  std::uint64_t seed_ = 0;
  bool is_exact_ = true;
  std::array<std::array<double, 3>, kMeasuredFields> biases_{};
};

}  // namespace tcs
