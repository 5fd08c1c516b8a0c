// Dead reckoning: the odometry that a robot's firmware computes from how far its wheels have
// turned.
#pragma once

#include <optional>
#include <vector>

#include "coordinator/world/instruments/instrument.h"

namespace tcs {

class WheelOdometry final : public Instrument {
 public:
  explicit WheelOdometry(const WheelOdometrySpec& spec);
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  // The means of the two sides, positive ahead.
  struct Sides {
    double left = 0, right = 0;
  };
  Sides MeansOf(double JointState::*what) const;
  void Go(double ahead_m, double turn_rad);

  WheelOdometrySpec spec_;
  std::vector<JointState> wheels_;
  std::optional<Sides> before_rad_;
  double yaw_rad_ = 0;
  OdometryMeasurement measured_;
};

}  // namespace tcs
