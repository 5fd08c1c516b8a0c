// Sensors that look at how one link moves.
#pragma once

#include <array>

#include "coordinator/world/instruments/instrument.h"
#include "simbody_bridge/link_inertial.h"

namespace tcs {

// How the frame of the mount moves.
LinkState LookAt(const Mount& mount, const Eyes& eyes);

class Imu final : public Instrument {
 public:
  Imu(const ImuSpec& spec, const std::array<double, 3>& gravity_mps2);
  std::span<const int> links() const override { return {&spec_.mount.link, 1}; }
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
  std::span<const int> links() const override { return {&spec_.mount.link, 1}; }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  TruthSpec spec_;
  OdometryMeasurement measured_;
};

class Gnss final : public Instrument {
 public:
  explicit Gnss(const GnssSpec& spec);
  std::span<const int> links() const override { return {&spec_.mount.link, 1}; }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  GnssSpec spec_;
  GnssMeasurement measured_;
};

class Magnetometer final : public Instrument {
 public:
  explicit Magnetometer(const MagnetometerSpec& spec);
  std::span<const int> links() const override { return {&spec_.mount.link, 1}; }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  MagnetometerSpec spec_;
  MagneticMeasurement measured_;
};

class Barometer final : public Instrument {
 public:
  explicit Barometer(const BarometerSpec& spec);
  std::span<const int> links() const override { return {&spec_.mount.link, 1}; }
  void Look(int number, VirtualTime now, const Eyes& eyes) override;
  Measurement Finish() override { return measured_; }

 private:
  BarometerSpec spec_;
  PressureMeasurement measured_;
};

// The pressure in the standard atmosphere, `height_m` above the place where it is `ground_pa`.
double PressureAt(double height_m, double ground_pa);

}  // namespace tcs
