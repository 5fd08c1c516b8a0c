// What a body feels: an accelerometer and a gyroscope at its centre of mass, their axes the body's.
// Computed from its motion, whatever engine moves it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

// A world vector along the axes of a body with the orientation `q`.
inline std::array<double, 3> InBody(const std::array<double, 4>& q,
                                    const std::array<double, 3>& v) {
  const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                 a[0] * b[1] - a[1] * b[0]};
  };
  const std::array<double, 3> axis = {-q[0], -q[1], -q[2]};
  const std::array<double, 3> once = cross(axis, v), twice = cross(axis, once);
  std::array<double, 3> turned;
  for (std::size_t i = 0; i < 3; ++i) turned[i] = v[i] + 2 * (q[3] * once[i] + twice[i]);
  return turned;
}

struct InertialReading {
  std::array<double, 3> angular_rate_radps{};  // the body's frame
  // The same frame. Acceleration less gravity (none in free fall), meant over the time since the
  // reading before; the first has none.
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
