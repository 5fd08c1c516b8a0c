// What an accelerometer feels, against closed forms; none of them depends on how often it is read.
#include "simbody_bridge/link_inertial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "simbody_bridge/link_motion.h"

namespace tcs {
namespace {

constexpr double kG = 9.81;
using Vector = std::array<double, 3>;

Vector FeltBy(const std::function<LinkState(double seconds)>& motion, VirtualDuration apart) {
  LinkInertialSensor sensor({0, 0, -kG});
  VirtualTime at;
  EXPECT_FALSE(sensor.Sample(at, motion(0)).proper_acceleration_mps2.has_value());
  InertialReading reading;
  for (int i = 0; i < 5; ++i) {
    at = at + apart;
    reading = sensor.Sample(at, motion(static_cast<double>(at.ns()) * 1e-9));
  }
  return reading.proper_acceleration_mps2.value();
}

void ExpectNear(const Vector& felt, const Vector& exact) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(felt[i], exact[i], 1e-9) << i;
}

class LinkInertial : public testing::TestWithParam<VirtualDuration> {};

TEST_P(LinkInertial, AtRestIsG) {
  LinkState tilted;
  tilted.pose.orientation_xyzw = FromRollPitchYaw(0.5, 0, 0);
  ExpectNear(FeltBy([&](double) { return tilted; }, GetParam()),
             {0, kG * std::sin(0.5), kG * std::cos(0.5)});
}

TEST_P(LinkInertial, InFreeFallIsNothing) {
  ExpectNear(FeltBy(
                 [](double t) {
                   LinkState falling;
                   falling.linear_velocity_mps = {3, 0, 1 - kG * t};
                   return falling;
                 },
                 GetParam()),
             {});
}

TEST_P(LinkInertial, OnATurntableIsTheCentripetalAcceleration) {
  constexpr double kRate = 8, kRadius = 0.7;
  ExpectNear(FeltBy(
                 [](double t) {
                   LinkState table;
                   table.pose.orientation_xyzw = FromRollPitchYaw(0, 0, kRate * t);
                   table.angular_velocity_radps = {0, 0, kRate};
                   return Mounted(table, {{kRadius, 0, 0}, {0, 0, 0, 1}});
                 },
                 GetParam()),
             {-kRate * kRate * kRadius, 0, kG});
}

INSTANTIATE_TEST_SUITE_P(Rates, LinkInertial,
                         testing::Values(VirtualDuration::Milliseconds(1),
                                         VirtualDuration::Milliseconds(10),
                                         VirtualDuration::Milliseconds(200)),
                         [](const auto& rate) { return std::to_string(rate.param.ns()); });

}  // namespace
}  // namespace tcs
