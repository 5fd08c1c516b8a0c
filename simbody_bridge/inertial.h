// The inertial sensor of a body: an accelerometer and a gyroscope at the body's centre of mass,
// along the body's axes. Readings are computed from the body's motion, whatever engine moves it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/frames.h"

namespace tcs {

struct InertialReading {
  std::array<double, 3> angular_rate_radps{};  // the body's frame
  // In the body's frame, too: acceleration less gravity (0 in free fall), the mean over the time
  // since the reading before; the first reading has none.
  std::optional<std::array<double, 3>> proper_acceleration_mps2;
};

class InertialSensor {
 public:
  explicit InertialSensor(const std::array<double, 3>& gravity_mps2)
      : gravity_mps2_(gravity_mps2) {}

  // The reading at `at`, later than the one before.
  InertialReading Sample(VirtualTime at, const BodyState& state) {
    InertialReading reading{InBody(state.orientation_xyzw, state.angular_velocity_radps), {}};
    if (before_.has_value()) {
      const double seconds = static_cast<double>((at - before_->at).ns()) * 1e-9;
      std::array<double, 3> felt_mps2;
      for (std::size_t i = 0; i < 3; ++i) {
        felt_mps2[i] =
            (state.linear_velocity_mps[i] - before_->velocity_mps[i]) / seconds - gravity_mps2_[i];
      }
      reading.proper_acceleration_mps2 = InBody(state.orientation_xyzw, felt_mps2);
    }
    before_ = {at, state.linear_velocity_mps};
    return reading;
  }

 private:
  struct Before {
    VirtualTime at;
    std::array<double, 3> velocity_mps;
  };
  std::array<double, 3> gravity_mps2_;
  std::optional<Before> before_;
};

}  // namespace tcs
