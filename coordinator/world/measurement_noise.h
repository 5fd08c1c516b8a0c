// The errors of what a robot's sensor measures: noise and bias.
//
// Pure. The errors of a sample depend on the sensor's seed and the sample's number alone.
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

  // Adds the errors of the sample of that number (a number always has the same errors), and sets
  // the variances of the measurement. A bias that is known does not count there.
  void Disturb(std::uint64_t sample, Measurement* measurement) const;

 private:
  class Draws;

  MeasurementErrors errors_{};
  std::uint64_t seed_ = 0;
  bool is_exact_ = true;
  std::array<std::array<double, 3>, kMeasuredFields> biases_{};
};

}  // namespace tcs
