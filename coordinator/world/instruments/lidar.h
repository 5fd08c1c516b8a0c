// Scanners that turn, with one layer of rays and with several.
#pragma once

#include <array>
#include <vector>

#include "coordinator/world/instruments/instrument.h"
#include "coordinator/world/instruments/ray_sweep.h"

namespace tcs {

class Lidar final : public Instrument {
 public:
  Lidar(const LidarSpec& spec, VirtualDuration period, const WorldSpec& world);
  Looks looks() const override { return sweep_.looks(); }
  std::span<const int> links() const override { return sweep_.links(); }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  LidarSpec spec_;
  RaySweep sweep_;
  ScanMeasurement measured_;
};

class Lidar3d final : public Instrument {
 public:
  Lidar3d(const Lidar3dSpec& spec, const WorldSpec& world);
  Looks looks() const override { return sweep_.looks(); }
  std::span<const int> links() const override { return sweep_.links(); }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  Lidar3dSpec spec_;
  RaySweep sweep_;
  CloudMeasurement measured_;
};

// A distance as a sensor tells it: infinity beyond the sensor's reach, minus infinity before it
// (REP-117).
double WithinReach(double distance_m, const ReachSpec& reach);

}  // namespace tcs
