#include "coordinator/world/trajectory_follower.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/unit/times.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

JointTrajectory To(double position, std::int64_t ms) {
  return {.joints = {1}, .points = {{Ms(ms), {position}, {}}}, .start = {}};
}

TEST(JointTrajectory, WithoutVelocitiesIsMadeOfStraightLines) {
  JointTrajectory trajectory = To(2, 100);
  trajectory.points.push_back({Ms(300), {1}, {}});
  EXPECT_DOUBLE_EQ(SetpointAt(trajectory, 0, 1, Ms(0)).position, 1);
  EXPECT_DOUBLE_EQ(SetpointAt(trajectory, 0, 1, Ms(25)).position, 1.25);
  EXPECT_DOUBLE_EQ(SetpointAt(trajectory, 0, 1, Ms(25)).velocity, 10);
  EXPECT_DOUBLE_EQ(SetpointAt(trajectory, 0, 1, Ms(200)).position, 1.5);
  EXPECT_DOUBLE_EQ(SetpointAt(trajectory, 0, 1, Ms(200)).velocity, -5);
  EXPECT_DOUBLE_EQ(SetpointAt(trajectory, 0, 1, Ms(300)).position, 1);
  EXPECT_DOUBLE_EQ(SetpointAt(trajectory, 0, 1, Ms(9000)).velocity, 0);
}

// t^3 - 2 t^2 + t + 3 is a cubic, and so it comes out again.
TEST(JointTrajectory, WithVelocitiesIsMadeOfCubics) {
  const auto position = [](double t) { return t * t * t - 2 * t * t + t + 3; };
  const auto velocity = [](double t) { return 3 * t * t - 4 * t + 1; };
  JointTrajectory trajectory{.joints = {0}, .points = {}, .start = {}};
  for (const std::int64_t ms : {0, 500, 2000}) {
    const double t = static_cast<double>(ms) * 1e-3;
    trajectory.points.push_back({Ms(ms), {position(t)}, {velocity(t)}});
  }
  for (const std::int64_t ms : {1, 300, 700, 1999}) {
    const double t = static_cast<double>(ms) * 1e-3;
    const JointSetpoint wanted = SetpointAt(trajectory, 0, 77, Ms(ms));
    EXPECT_NEAR(wanted.position, position(t), 1e-12) << t;
    EXPECT_NEAR(wanted.velocity, velocity(t), 1e-12) << t;
  }
}

TEST(JointTrajectory, LeavesAJointOut) {
  JointTrajectory trajectory{.joints = {0, 2, 1}, .points = {}, .start = {}};
  trajectory.points.push_back({Ms(10), {1, 2, 3}, {4, 5, 6}});
  trajectory.points.push_back({Ms(20), {7, 8, 9}, {}});
  LeaveOut(1, &trajectory);
  EXPECT_EQ(trajectory.joints, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(trajectory.points[0].positions, (std::vector<double>{1, 3}));
  EXPECT_EQ(trajectory.points[0].velocities, (std::vector<double>{4, 6}));
  EXPECT_EQ(trajectory.points[1].positions, (std::vector<double>{7, 9}));
  EXPECT_TRUE(trajectory.points[1].velocities.empty());
}

TEST(JointTrajectory, WhatIsNoneIsSaid) {
  JointTrajectory trajectory = To(2, 100);
  EXPECT_EQ(WhatIsWrongWith(trajectory), "");
  trajectory.points.push_back({Ms(100), {1}, {}});
  EXPECT_THAT(WhatIsWrongWith(trajectory), HasSubstr("not after the one before"));
  trajectory.points[1] = {Ms(200), {1, 2}, {}};
  EXPECT_THAT(WhatIsWrongWith(trajectory), HasSubstr("another number"));
  trajectory.points[1] = {Ms(200), {std::numeric_limits<double>::quiet_NaN()}, {}};
  EXPECT_THAT(WhatIsWrongWith(trajectory), HasSubstr("not finite"));
  EXPECT_THAT(WhatIsWrongWith({}), HasSubstr("no points"));
}

class TrajectoryFollowerTest : public testing::Test {
 protected:
  void ActUntil(VirtualTime until) {
    follower_.ActUntil(
        until,
        [this](VirtualTime at, std::span<const int> joints, std::span<JointState> states) {
          EXPECT_THAT(std::vector<int>(joints.begin(), joints.end()), ElementsAre(8));
          read_ms_.push_back(at.ns() / 1'000'000);
          states[0].position = was_at_;
        },
        [this](VirtualTime at, std::span<const JointGoal> goals) {
          ASSERT_EQ(goals.size(), 1u);
          EXPECT_EQ(goals[0].joint, 1u);
          at_ms_.push_back(at.ns() / 1'000'000);
          positions_.push_back(*goals[0].position);
        });
  }

  void ExpectPositions(const std::vector<double>& wanted) const {
    EXPECT_THAT(positions_, testing::Pointwise(testing::DoubleNear(1e-12), wanted));
  }

  TrajectoryFollower follower_{{"arm", {7, 8}, {"shoulder", "elbow"}}, Ms(10)};
  double was_at_ = 0;
  std::vector<std::int64_t> at_ms_, read_ms_;
  std::vector<double> positions_;
};

TEST_F(TrajectoryFollowerTest, LeadsTheJointFromWhereItIsToTheEnd) {
  was_at_ = 1;
  follower_.Follow(AtMs(5), To(2, 25));
  EXPECT_EQ(follower_.NextStop(), AtMs(5));
  ActUntil(AtMs(14));
  EXPECT_EQ(follower_.NextStop(), AtMs(15));
  ActUntil(AtMs(1000));
  EXPECT_THAT(at_ms_, ElementsAre(5, 15, 25, 30));
  ExpectPositions({1, 1.4, 1.8, 2});
  EXPECT_THAT(read_ms_, ElementsAre(5));
  EXPECT_EQ(follower_.NextStop(), VirtualTime::Never());
}

TEST_F(TrajectoryFollowerTest, ANewTrajectoryReplacesTheOldOneWhenItStarts) {
  follower_.Follow(AtMs(0), To(10, 100));
  JointTrajectory later = To(0, 20);
  later.start = AtMs(25);
  follower_.Follow(AtMs(3), later);
  ActUntil(AtMs(20));
  was_at_ = 5;
  ActUntil(AtMs(1000));
  EXPECT_THAT(at_ms_, ElementsAre(0, 10, 20, 25, 35, 45));
  ExpectPositions({0, 1, 2, 5, 2.5, 0});
}

TEST_F(TrajectoryFollowerTest, WhatWasToStartLaterIsReplacedAtOnce) {
  JointTrajectory later = To(7, 20);
  later.start = AtMs(500);
  follower_.Follow(AtMs(0), later);
  follower_.Follow(AtMs(10), To(1, 10));
  ActUntil(AtMs(1000));
  EXPECT_THAT(at_ms_, ElementsAre(10, 20));
}

TEST_F(TrajectoryFollowerTest, OneThatHasBegunBeforeItComesGoesOnFromThere) {
  JointTrajectory late = To(4, 40);
  late.start = AtMs(10);
  follower_.Follow(AtMs(30), late);
  ActUntil(AtMs(1000));
  EXPECT_THAT(at_ms_, ElementsAre(30, 40, 50));
  ExpectPositions({2, 3, 4});
}

}  // namespace
}  // namespace tcs
