#include "coordinator/world/sensor_noise.h"

#include <algorithm>

#include "shm/random_stream.h"
#include "simbody_bridge/link_motion.h"

namespace tcs {
namespace {

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

double* NumberOf(JointState* joint, JointQuantity quantity) {
  switch (quantity) {
    case JointQuantity::kPosition:
      return &joint->position;
    case JointQuantity::kVelocity:
      return &joint->velocity;
    case JointQuantity::kEffort:
      break;
  }
  return &joint->effort;
}

}  // namespace

SensorNoise::SensorNoise(const SensorErrors& errors, std::size_t bodies, std::size_t joints)
    : errors_(errors),
      is_exact_(std::ranges::all_of(errors.fields, &FieldError::IsExact) &&
                std::ranges::all_of(errors.joints, &FieldError::IsExact)) {
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
  for (std::size_t joint = 0; joint < joints; ++joint) {
    RandomStream random(errors_.seed, RandomPurpose::kBias, joint);
    JointBiases& biases = joint_biases_.emplace_back();
    for (std::size_t i = 0; i < biases.size(); ++i) {
      const FieldError& field = errors_.joints[i];
      biases[i] = field.bias[0] + field.bias_deviation * random.Normal();
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

void SensorNoise::Disturb(std::uint64_t sample, Reading* reading) const {
  if (is_exact_) return;
  DisturbBodies(sample, reading);
  DisturbJoints(sample, reading);
}

// Every value has its place in the stream, whether it has noise or not: a noise that is added to
// one field leaves the others as they were.
void SensorNoise::DisturbBodies(std::uint64_t sample, Reading* reading) const {
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

void SensorNoise::DisturbJoints(std::uint64_t sample, Reading* reading) const {
  RandomStream random(errors_.seed, RandomPurpose::kNoise, sample);
  for (std::size_t joint = 0; joint < reading->joints.size(); ++joint) {
    for (std::size_t i = 0; i < kJointQuantities.size(); ++i) {
      *NumberOf(&reading->joints[joint].state, static_cast<JointQuantity>(i)) +=
          joint_biases_[joint][i] + errors_.joints[i].noise * random.Normal();
    }
  }
}

}  // namespace tcs
