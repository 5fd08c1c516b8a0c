// Sensors that see what is ahead of them at one instant.
#pragma once

#include <array>
#include <vector>

#include "coordinator/world/instruments/instrument.h"
#include "coordinator/world/instruments/seen.h"

namespace tcs {

// An ultrasonic or infrared sensor: rays all over its cone, of which the shortest counts.
class RangeFinder final : public Instrument {
 public:
  RangeFinder(const RangeSpec& spec, const WorldSpec& world);
  std::span<const int> links() const override { return seen_.links(); }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  RangeSpec spec_;
  Seen seen_;
  std::vector<std::array<double, 3>> directions_;
  RangeMeasurement measured_;
};

class DepthCamera final : public Instrument {
 public:
  DepthCamera(const DepthCameraSpec& spec, const WorldSpec& world);
  std::span<const int> links() const override { return seen_.links(); }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  DepthCameraSpec spec_;
  Seen seen_;
  DepthMeasurement measured_;
};

}  // namespace tcs
