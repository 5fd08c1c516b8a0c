#include "coordinator/world/sensor_noise.h"

#include <cmath>

#include "coordinator/world/random_stream.h"

namespace tcs {
namespace {

// The orientation turned by `turn`, a rotation about the body's axes.
std::array<double, 4> Turned(const std::array<double, 4>& q, const std::array<double, 3>& turn) {
  const double angle = std::hypot(turn[0], turn[1], turn[2]);
  if (angle == 0) return q;
  const double s = std::sin(angle / 2) / angle, w = std::cos(angle / 2);
  const double x = turn[0] * s, y = turn[1] * s, z = turn[2] * s;
  return {q[3] * x + q[0] * w + q[1] * z - q[2] * y, q[3] * y - q[0] * z + q[1] * w + q[2] * x,
          q[3] * z + q[0] * y - q[1] * x + q[2] * w, q[3] * w - q[0] * x - q[1] * y - q[2] * z};
}

std::array<double, 3>* VectorOf(BodyReading* body, SensorField field) {
  switch (field) {
    case SensorField::kPosition:
      return &body->state.position_m;
    case SensorField::kLinearVelocity:
      return &body->state.linear_velocity_mps;
    case SensorField::kAngularVelocity:
      return &body->state.angular_velocity_radps;
    case SensorField::kAngularRate:
      return &body->felt.angular_rate_radps;
    case SensorField::kProperAcceleration:
      return body->felt.proper_acceleration_mps2.has_value() ? &*body->felt.proper_acceleration_mps2
                                                             : nullptr;
    case SensorField::kOrientation:
    case SensorField::kCount:
      break;
  }
  return nullptr;
}

}  // namespace

SensorNoise::SensorNoise(const SensorErrors& errors, std::size_t bodies)
    : errors_(errors), is_exact_(true) {
  for (const FieldError& field : errors_.fields) {
    is_exact_ &= field.noise == 0 && field.bias_deviation == 0 && field.bias == FieldError{}.bias;
  }
  for (std::size_t body = 0; body < bodies; ++body) {
    RandomStream random(errors_.seed, RandomPurpose::kBias, body);
    Biases& biases = biases_.emplace_back();
    for (std::size_t i = 0; i < kSensorFields; ++i) {
      const FieldError& field = errors_.fields[i];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        biases[i][axis] = field.bias[axis] + field.bias_deviation * random.Normal();
      }
    }
  }
}

SensorNoise::Fate SensorNoise::FateOf(std::uint64_t sample) const {
  if (errors_.dropout == 0 && errors_.jitter == VirtualDuration{}) return {};
  RandomStream random(errors_.seed, RandomPurpose::kFate, sample);
  const bool is_lost = random.Uniform() < errors_.dropout;
  const double late_ns = random.Uniform() * static_cast<double>(errors_.jitter.ns());
  return {is_lost, VirtualDuration::Nanoseconds(static_cast<std::int64_t>(late_ns))};
}

// Every value has its place in the stream, whether it has noise or not: a noise that is added to
// one field leaves the others as they were.
void SensorNoise::Disturb(std::uint64_t sample, Reading* reading) const {
  if (is_exact_) return;
  RandomStream random(errors_.seed, RandomPurpose::kNoise, sample);
  for (std::size_t body = 0; body < reading->bodies.size(); ++body) {
    BodyReading& of = reading->bodies[body];
    for (std::size_t i = 0; i < kSensorFields; ++i) {
      std::array<double, 3> error = biases_[body][i];
      for (double& axis : error) axis += errors_.fields[i].noise * random.Normal();
      const auto field = static_cast<SensorField>(i);
      if (field == SensorField::kOrientation) {
        of.state.orientation_xyzw = Turned(of.state.orientation_xyzw, error);
      } else if (std::array<double, 3>* vector = VectorOf(&of, field); vector != nullptr) {
        for (std::size_t axis = 0; axis < 3; ++axis) (*vector)[axis] += error[axis];
      }
    }
  }
}

}  // namespace tcs
