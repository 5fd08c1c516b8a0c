// The readings of an accelerometer and a gyroscope that are mounted on a link, along their own
// axes. They are computed from the link's motion, whatever engine moves it.
#pragma once

#include <array>
#include <optional>

#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/inertial.h"

namespace tcs {

// The acceleration is the mean since the reading before, of what is felt along axes that turn
// meanwhile at a steady rate: exact at rest, in free fall, and on a turntable, whatever the rate of
// readings. Less than half a turn lies between two readings.
class LinkInertialSensor {
 public:
  explicit LinkInertialSensor(const std::array<double, 3>& gravity_mps2)
      : gravity_mps2_(gravity_mps2) {}

  // The reading at `at`, later than the one before, of the frame that moves so.
  InertialReading Sample(VirtualTime at, const LinkState& frame);

 private:
  struct Before {
    VirtualTime at;
    LinkState frame;
  };
  std::array<double, 3> gravity_mps2_;
  std::optional<Before> before_;
};

}  // namespace tcs
