// Sensors that look at how one link moves.
#pragma once

#include "coordinator/world/instruments/instrument.h"
#include "simbody_bridge/link_inertial.h"

namespace tcs {

class Imu final : public Instrument {
 public:
  Imu(const ImuSpec& spec, const std::array<double, 3>& gravity_mps2);
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  ImuSpec spec_;
  LinkInertialSensor felt_;
  ImuMeasurement measured_;
};

class Truth final : public Instrument {
 public:
  explicit Truth(const TruthSpec& spec);
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  TruthSpec spec_;
  OdometryMeasurement measured_;
};

// How the frame of the mount moves.
LinkState LookAt(const Mount& mount, const Eyes& eyes);

}  // namespace tcs
