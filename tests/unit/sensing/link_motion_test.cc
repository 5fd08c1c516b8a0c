#include "simbody_bridge/link_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tcs {
namespace {

// On a circle about z, with its x axis outwards.
LinkState OnCircle(double angle_rad, double rate_radps, double radius_m) {
  LinkState state;
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  state.pose = {{radius_m * c, radius_m * s, 0}, FromRollPitchYaw(0, 0, angle_rad)};
  state.linear_velocity_mps = {-radius_m * rate_radps * s, radius_m * rate_radps * c, 0};
  state.angular_velocity_radps = {0, 0, rate_radps};
  return state;
}

TEST(LinkMotion, BetweenTwoInstantsALinkGoesOnAsItsVelocitiesSay) {
  constexpr double kRate = 4, kSeconds = 0.005;
  const LinkState from = OnCircle(0.3, kRate, 2), to = OnCircle(0.3 + kRate * kSeconds, kRate, 2);
  for (const double part : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    const Pose pose = PoseBetween(from, to, kSeconds, part);
    const Pose exact = OnCircle(0.3 + part * kRate * kSeconds, kRate, 2).pose;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(pose.position_m[i], exact.position_m[i], 1e-9);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(pose.orientation_xyzw[i], exact.orientation_xyzw[i], 1e-12);
    }
  }
}

TEST(LinkMotion, WhatIsMountedMovesWithItsLink) {
  const LinkState mounted = Mounted(OnCircle(0, 2, 3), {{1, 0, 0.5}, FromRollPitchYaw(0, 0, 1)});
  EXPECT_NEAR(mounted.pose.position_m[0], 4, 1e-12);
  EXPECT_NEAR(mounted.pose.position_m[2], 0.5, 1e-12);
  EXPECT_NEAR(mounted.linear_velocity_mps[1], 8, 1e-12);
  EXPECT_NEAR(mounted.linear_velocity_mps[0], 0, 1e-12);
  EXPECT_EQ(mounted.angular_velocity_radps[2], 2);
}

TEST(LinkMotion, TheTurnBetweenTwoOrientationsTakesTheOneToTheOther) {
  const auto a = FromRollPitchYaw(0.3, -1.1, 2), b = FromRollPitchYaw(-2.5, 0.4, -0.9);
  const auto there = Turned(a, TurnBetween(a, b));
  double product = 0;
  for (std::size_t i = 0; i < 4; ++i) product += there[i] * b[i];
  EXPECT_NEAR(std::abs(product), 1, 1e-12);
}

}  // namespace
}  // namespace tcs
