#include "coordinator/world/sensor_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace tcs {
namespace {

constexpr int kSamples = 20'000;

SensorErrors With(SensorField field, FieldError error, std::uint64_t seed = 7) {
  SensorErrors errors;
  errors.fields[static_cast<std::size_t>(field)] = error;
  errors.seed = seed;
  return errors;
}

Reading Exact() {
  Reading reading;
  reading.bodies.push_back({"ship", {.position_m = {1, 2, 3}}, {}});
  reading.bodies.back().felt.proper_acceleration_mps2 = {0, 0, 9.8};
  return reading;
}

Reading Disturbed(const SensorNoise& noise, std::uint64_t sample) {
  Reading reading = Exact();
  noise.Disturb(sample, &reading);
  return reading;
}

TEST(SensorNoise, WithoutErrorsNothingChanges) {
  const Reading reading = Disturbed(SensorNoise({}, 1), 3);
  EXPECT_EQ(reading.bodies[0].state.position_m, Exact().bodies[0].state.position_m);
  EXPECT_FALSE(SensorNoise({}, 1).FateOf(3).is_lost);
}

TEST(SensorNoise, HasTheDeviationThatWasAskedFor) {
  const SensorNoise noise(With(SensorField::kPosition, {.noise = 0.5}), 1);
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double error =
        Disturbed(noise, static_cast<std::uint64_t>(i)).bodies[0].state.position_m[1] - 2;
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / kSamples, 0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / kSamples), 0.5, 0.01);
}

// Whoever asked for what before.
TEST(SensorNoise, DependsOnTheSeedAndTheSampleAlone) {
  const SensorNoise noise(With(SensorField::kPosition, {.noise = 1}), 1);
  const SensorNoise again(With(SensorField::kPosition, {.noise = 1}), 1);
  const SensorNoise other(With(SensorField::kPosition, {.noise = 1}, 8), 1);
  const auto at = [](const SensorNoise& of, std::uint64_t sample) {
    return Disturbed(of, sample).bodies[0].state.position_m;
  };
  const auto fifth = at(noise, 5);
  EXPECT_NE(at(noise, 4), fifth);
  EXPECT_EQ(at(again, 5), fifth);
  EXPECT_NE(at(other, 5), fifth);
}

TEST(SensorNoise, OfOneFieldLeavesTheOthersAsTheyWere) {
  const SensorNoise one(With(SensorField::kPosition, {.noise = 1}), 1);
  SensorErrors errors = With(SensorField::kPosition, {.noise = 1});
  errors.fields[static_cast<std::size_t>(SensorField::kAngularRate)].noise = 2;
  errors.dropout = 0.5;
  const SensorNoise both(errors, 1);
  EXPECT_EQ(Disturbed(one, 9).bodies[0].state.position_m,
            Disturbed(both, 9).bodies[0].state.position_m);
}

TEST(SensorNoise, ABiasStaysForTheRun) {
  const SensorNoise fixed(With(SensorField::kProperAcceleration, {.bias = {0.1, 0, -0.2}}), 1);
  EXPECT_EQ(Disturbed(fixed, 0).bodies[0].felt.proper_acceleration_mps2,
            (std::array<double, 3>{0.1, 0, 9.8 - 0.2}));
  const SensorNoise drawn(With(SensorField::kAngularRate, {.bias_deviation = 1}), 1);
  const auto rate = Disturbed(drawn, 0).bodies[0].felt.angular_rate_radps;
  EXPECT_NE(rate[0], 0);
  EXPECT_NE(rate[0], rate[1]);
  EXPECT_EQ(Disturbed(drawn, 1).bodies[0].felt.angular_rate_radps, rate);
}

TEST(SensorNoise, OrientationsStayUnitQuaternions) {
  const SensorNoise noise(With(SensorField::kOrientation, {.noise = 0.3}), 1);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto q = Disturbed(noise, i).bodies[0].state.orientation_xyzw;
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-12);
    EXPECT_LT(q[3], 1);
  }
}

TEST(SensorNoise, OfJointsIsOfEachQuantityAndJoint) {
  SensorErrors errors;
  errors.seed = 7;
  errors.joints[static_cast<std::size_t>(JointQuantity::kPosition)] = {.noise = 0.5};
  errors.joints[static_cast<std::size_t>(JointQuantity::kVelocity)] = {.bias = {0.25, 0, 0}};
  errors.joints[static_cast<std::size_t>(JointQuantity::kEffort)] = {.bias_deviation = 1};
  const SensorNoise noise(errors, 0, 2);
  const auto read = [&noise](std::uint64_t sample) {
    Reading reading;
    reading.joints = {{"elbow", {1, 2, 3}}, {"wrist", {1, 2, 3}}};
    noise.Disturb(sample, &reading);
    return reading.joints;
  };
  double squares = 0;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    const auto joints = read(i);
    squares += (joints[1].state.position - 1) * (joints[1].state.position - 1);
    EXPECT_NE(joints[0].state.position, joints[1].state.position);
    EXPECT_EQ(joints[0].state.velocity, 2.25);
    EXPECT_EQ(joints[0].state.effort, read(0)[0].state.effort) << "it is drawn once";
  }
  EXPECT_NEAR(std::sqrt(squares / kSamples), 0.5, 0.01);
  EXPECT_NE(read(0)[0].state.effort, read(0)[1].state.effort);
  EXPECT_EQ(read(5)[0].state.position, read(5)[0].state.position);
}

TEST(SensorNoise, LosesAndDelaysTheShareThatWasAskedFor) {
  SensorErrors errors;
  errors.dropout = 0.25;
  errors.jitter = VirtualDuration::Milliseconds(8);
  const SensorNoise noise(errors, 1);
  int lost = 0;
  double late_ns = 0;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    const SensorNoise::Fate fate = noise.FateOf(i);
    lost += fate.is_lost ? 1 : 0;
    late_ns += static_cast<double>(fate.late.ns());
    ASSERT_GE(fate.late.ns(), 0);
    ASSERT_LT(fate.late, errors.jitter);
  }
  EXPECT_NEAR(lost, 0.25 * kSamples, 200);
  EXPECT_NEAR(late_ns / kSamples, 4e6, 1e5);
}

}  // namespace
}  // namespace tcs
