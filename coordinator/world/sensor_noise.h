// The errors of a sensor's readings: noise, bias, samples that are lost or late.
//
// Pure. The errors of a sample depend on the sensor's seed and the sample's number alone: not on
// other sensors, nor on which thread ran when.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class SensorNoise {
 public:
  SensorNoise(const SensorErrors& errors, std::size_t bodies, std::size_t joints = 0);

  struct Fate {
    bool is_lost = false;
    VirtualDuration late{};  // beyond its latency
  };
  // The fate of the sample of that number.
  Fate FateOf(std::uint64_t sample) const;
  // Adds the errors of the sample's values; a number always has the same errors.
  void Disturb(std::uint64_t sample, Reading* reading) const;

 private:
  using Biases = std::array<std::array<double, 3>, kSensorFields>;
  using JointBiases = std::array<double, kJointQuantities.size()>;
  void DisturbBodies(std::uint64_t sample, Reading* reading) const;
  void DisturbJoints(std::uint64_t sample, Reading* reading) const;

  SensorErrors errors_;
  bool is_exact_;               // values have no errors
  std::vector<Biases> biases_;  // of each body
  std::vector<JointBiases> joint_biases_;
};

}  // namespace tcs
