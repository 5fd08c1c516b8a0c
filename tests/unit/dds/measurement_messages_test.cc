// What sensors of robots measure, as ROS 2's messages; tests/scenario/robots_sense_over_dds.sh has
// the values of them all.
#include "coordinator/dds/measurement_messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/dds/samples.h"

namespace tcs::dds {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(LaserScan, SaysWhatIsOutOfReachAsRosDoes) {
  const auto scan = ToMessage(kStamp, ScanMeasurement{.frame = "laser",
                                                      .first_rad = -1,
                                                      .step_rad = 0.5,
                                                      .ray_s = 0.01,
                                                      .scan_s = 0.1,
                                                      .least_m = 0.1,
                                                      .most_m = 8,
                                                      .ranges_m = {1.5, kInfinity, -kInfinity}});
  EXPECT_STREQ(scan->header.frame_id, "laser");
  EXPECT_EQ(scan->header.stamp.nanosec, 250'000'000u);
  EXPECT_EQ(scan->angle_max, 0);
  ASSERT_EQ(scan->ranges._length, 3u);
  EXPECT_EQ(scan->ranges._buffer[0], 1.5f);
  EXPECT_TRUE(std::isinf(scan->ranges._buffer[1]) && scan->ranges._buffer[1] > 0);
  EXPECT_TRUE(std::isinf(scan->ranges._buffer[2]) && scan->ranges._buffer[2] < 0);
}

TEST(PointCloud, HasAPointAfterTheOther) {
  CloudMeasurement cloud{.frame = "laser", .points = {}};
  cloud.points.push_back({{1, 0, 0}, 2, 0.25, 3});
  cloud.points.push_back({{0, 0, 1}, 4, 0.5, 1});
  const auto message = ToMessage(kStamp, cloud);
  EXPECT_EQ(message->width, 2u);
  EXPECT_EQ(message->row_step, 36u);
  ASSERT_EQ(message->data._length, 36u);
  float numbers[4];
  memcpy(numbers, message->data._buffer + 18, sizeof numbers);
  EXPECT_EQ(numbers[2], 4);
  EXPECT_EQ(numbers[3], 0.5);
  EXPECT_EQ(message->data._buffer[18 + 16], 1);
}

TEST(Covariances, AreDiagonalAndInTheirOwnPlaces) {
  const auto imu = ToMessage(kStamp, ImuMeasurement{.felt = {{}, std::array<double, 3>{}},
                                                    .orientation_variance = 1,
                                                    .rate_variance = 2,
                                                    .acceleration_variance = 3});
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(imu->orientation_covariance[i], i % 4 == 0 ? 1 : 0) << i;
    EXPECT_EQ(imu->angular_velocity_covariance[i], i % 4 == 0 ? 2 : 0) << i;
    EXPECT_EQ(imu->linear_acceleration_covariance[i], i % 4 == 0 ? 3 : 0) << i;
  }
  const auto odometry = ToMessage(kStamp, OdometryMeasurement{.position_variance = 1,
                                                              .orientation_variance = 2,
                                                              .linear_variance = 3,
                                                              .angular_variance = 4});
  for (int i = 0; i < 36; ++i) {
    EXPECT_EQ(odometry->pose.covariance[i], i % 7 != 0 ? 0 : i < 21 ? 1 : 2) << i;
    EXPECT_EQ(odometry->twist.covariance[i], i % 7 != 0 ? 0 : i < 21 ? 3 : 4) << i;
  }
  const auto fix = ToMessage(kStamp, GnssMeasurement{.position_variance = 4});
  for (int i = 0; i < 9; ++i) EXPECT_EQ(fix->position_covariance[i], i % 4 == 0 ? 4 : 0) << i;
  EXPECT_EQ(fix->position_covariance_type, 2) << "its diagonal is known";
  EXPECT_EQ(ToMessage(kStamp, GnssMeasurement{})->position_covariance_type, 0) << "unknown";
}

// What nobody knows yet stays so, whatever noise there will be.
TEST(Covariances, OfAnAccelerationThatIsNotKnownSayThat) {
  const auto imu = ToMessage(kStamp, ImuMeasurement{.acceleration_variance = 3});
  EXPECT_EQ(imu->linear_acceleration_covariance[0], -1);
}

// As of Iron a Range ends with its variance.
TEST(Range, HasTheFormOfTheRelease) {
  const RangeMeasurement range{.frame = "sonar", .range_m = 1};
  const auto humble = EncodeMeasurement(kStamp, range, RosRelease::kHumble);
  const auto iron = EncodeMeasurement(kStamp, range, RosRelease::kIron);
  ASSERT_EQ(humble.size() + 4, iron.size());
  EXPECT_TRUE(std::equal(humble.begin(), humble.end(), iron.begin()));
}

}  // namespace
}  // namespace tcs::dds
