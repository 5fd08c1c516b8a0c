#include "coordinator/world/measurement_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tcs {
namespace {

MeasurementErrors With(MeasuredField field, const FieldError& error) {
  MeasurementErrors errors{};
  errors[static_cast<std::size_t>(field)] = error;
  return errors;
}

ScanMeasurement Scan(const MeasurementNoise& noise, std::uint64_t sample) {
  Measurement measured =
      ScanMeasurement{.ranges_m = {1, std::numeric_limits<double>::infinity(), 3}};
  noise.Disturb(sample, &measured);
  return std::get<ScanMeasurement>(measured);
}

TEST(MeasurementNoise, WithoutErrorsNothingChanges) {
  EXPECT_EQ(Scan(MeasurementNoise({}, 7), 3).ranges_m[0], 1);
}

TEST(MeasurementNoise, EachRayHasItsOwnAndWhatIsOutOfReachHasNone) {
  const MeasurementNoise noise(With(MeasuredField::kRange, {.noise = 0.1}), 7);
  const ScanMeasurement scan = Scan(noise, 3);
  EXPECT_NE(scan.ranges_m[0] - 1, scan.ranges_m[2] - 3);
  EXPECT_TRUE(std::isinf(scan.ranges_m[1]));
  EXPECT_EQ(Scan(noise, 3).ranges_m, scan.ranges_m);
  EXPECT_NE(Scan(noise, 4).ranges_m, scan.ranges_m);
}

TEST(MeasurementNoise, HasTheDeviationThatWasAskedFor) {
  const MeasurementNoise noise(With(MeasuredField::kRange, {.noise = 0.5, .bias = {0.2, 0, 0}}), 7);
  constexpr int kSamples = 20'000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double error = Scan(noise, static_cast<std::uint64_t>(i)).ranges_m[2] - 3;
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / kSamples, 0.2, 0.02);
  EXPECT_NEAR(std::sqrt(squares / kSamples - 0.04), 0.5, 0.01);
}

// A bias that is known is not part of it; one that is drawn is.
TEST(MeasurementNoise, SaysItsVariance) {
  MeasurementErrors errors =
      With(MeasuredField::kAngularRate, {.noise = 0.3, .bias_deviation = 0.4});
  errors[static_cast<std::size_t>(MeasuredField::kOrientation)] = {.bias = {1, 1, 1}};
  Measurement measured = ImuMeasurement{};
  MeasurementNoise(errors, 7).Disturb(5, &measured);
  const auto& imu = std::get<ImuMeasurement>(measured);
  EXPECT_DOUBLE_EQ(imu.rate_variance, 0.25);
  EXPECT_EQ(imu.orientation_variance, 0);
  EXPECT_EQ(imu.acceleration_variance, 0);
  Measurement fix = GnssMeasurement{};
  MeasurementNoise(With(MeasuredField::kPosition, {.noise = 2}), 7).Disturb(5, &fix);
  EXPECT_EQ(std::get<GnssMeasurement>(fix).position_variance, 4);
}

TEST(MeasurementNoise, OfOneFieldLeavesTheOthersAsTheyWere) {
  const auto imu = [](const MeasurementErrors& errors) {
    Measurement measured = ImuMeasurement{};
    MeasurementNoise(errors, 7).Disturb(5, &measured);
    return std::get<ImuMeasurement>(measured).felt.angular_rate_radps;
  };
  MeasurementErrors errors = With(MeasuredField::kAngularRate, {.noise = 0.1});
  const auto alone = imu(errors);
  errors[static_cast<std::size_t>(MeasuredField::kOrientation)].noise = 1;
  EXPECT_EQ(imu(errors), alone);
  EXPECT_NE(alone[0], 0);
}

}  // namespace
}  // namespace tcs
