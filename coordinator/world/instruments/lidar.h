// A scanner that turns: each ray looks at its own instant.
#pragma once

#include "coordinator/world/instruments/instrument.h"
#include "coordinator/world/instruments/seen.h"

namespace tcs {

class Lidar final : public Instrument {
 public:
  Lidar(const LidarSpec& spec, VirtualDuration period, const WorldSpec& world);
  Looks looks() const override { return looks_; }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  void CastUpTo(int look);

  LidarSpec spec_;
  Looks looks_;
  Seen seen_;
  ScanMeasurement measured_;
  std::size_t cast_ = 0;  // rays of this sweep
};

// A distance as a sensor tells it that measures from `least_m` to `most_m`: what is beyond is at
// infinity, what is before at minus infinity (REP-117).
double WithinReach(double distance_m, double least_m, double most_m);

}  // namespace tcs
