#include "simbody_bridge/air.h"

#include <cmath>
#include <numbers>

#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

constexpr int kTones = 16;

// Tones of equal strength, at such frequencies that their spectrum is that of a noise that a filter
// of the first order has smoothed.
double ToneRadps(const WindSpec& spec, int tone) {
  return std::tan(std::numbers::pi / 2 * (tone + 0.5) / kTones) / spec.gust_time.seconds();
}

// Steele, Lea and Flood's SplitMix64, from 0 to below 1.
double Draw(std::uint64_t* state) {
  std::uint64_t z = *state += 0x9e3779b97f4a7c15;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
  z = (z ^ z >> 27) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
}

}  // namespace

Wind::Wind(const WindSpec& spec) : mean_mps_(spec.mean_mps) {
  if (spec.gusts_mps == 0) return;
  amplitude_mps_ = spec.gusts_mps * std::sqrt(2.0 / kTones);
  std::uint64_t state = spec.seed;
  for (int tone = 0; tone < kTones; ++tone) {
    tones_.push_back({ToneRadps(spec, tone), {}});
    for (double& phase : tones_.back().phases) phase = 2 * std::numbers::pi * Draw(&state);
  }
}

std::array<double, 3> Wind::At(VirtualTime t, double after_s) const {
  std::array<double, 3> velocity_mps = mean_mps_;
  const double seconds = t.seconds() + after_s;
  for (const Tone& tone : tones_) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      velocity_mps[axis] += amplitude_mps_ * std::sin(tone.radps * seconds + tone.phases[axis]);
    }
  }
  return velocity_mps;
}

double FastestGustRadps(const WindSpec& spec) {
  return spec.gusts_mps == 0 ? 0 : ToneRadps(spec, kTones - 1);
}

Load DragOn(const DragSpec& drag, const BodyState& body, const std::array<double, 3>& wind_mps) {
  std::array<double, 3> through_mps;
  for (std::size_t i = 0; i < 3; ++i) through_mps[i] = body.linear_velocity_mps[i] - wind_mps[i];
  const std::array<double, 3>& spin_radps = body.angular_velocity_radps;
  const double slows =
      drag.linear_nspm + drag.quadratic_ns2pm2 * std::sqrt(Dot(through_mps, through_mps));
  const double brakes = drag.angular_linear_nmsprad +
                        drag.angular_quadratic_nms2prad2 * std::sqrt(Dot(spin_radps, spin_radps));
  Load load;
  for (std::size_t i = 0; i < 3; ++i) {
    load.force_n[i] = -slows * through_mps[i];
    load.torque_nm[i] = -brakes * spin_radps[i];
  }
  return load;
}

}  // namespace tcs
