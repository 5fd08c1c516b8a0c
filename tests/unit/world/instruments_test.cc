// Sensors of robots on the engines' own motion, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coordinator/world/instruments/instrument.h"
#include "simbody_bridge/engines.h"

namespace tcs {
namespace {

constexpr double kG = 9.81;
constexpr auto Ms = VirtualDuration::Milliseconds;

Link Massive(const std::string& name, double size_m = 0.2) {
  Link link;
  link.name = name;
  link.inertial =
      Inertial{.mass_kg = 1, .frame = {}, .ixx_kgm2 = 0.01, .iyy_kgm2 = 0.01, .izz_kgm2 = 0.01};
  Shape shape;
  shape.geometry = BoxShape{{size_m, size_m, size_m}};
  link.shapes.push_back(shape);
  return link;
}

RobotModel Block(const std::string& name, const std::array<double, 3>& at) {
  RobotModel model;
  model.name = name;
  model.links.push_back(Massive(name));
  model.at.position_m = at;
  return model;
}

// A table that turns about z at a steady rate.
RobotModel Turntable(double rate_radps) {
  RobotModel model;
  model.name = "turntable";
  model.has_fixed_base = true;
  model.links = {{.name = "base", .inertial = {}, .shapes = {}}, Massive("table")};
  Joint joint;
  joint.name = "axle";
  joint.kind = JointKind::kContinuous;
  joint.parent = 0;
  joint.child = 1;
  joint.axis = {0, 0, 1};
  joint.initial_velocity = {rate_radps};
  model.joints.push_back(joint);
  return model;
}

Shape Fixture(const Geometry& geometry, const std::array<double, 3>& at = {}) {
  Shape shape;
  shape.geometry = geometry;
  shape.pose.position_m = at;
  return shape;
}

class Instruments : public testing::TestWithParam<EngineKind> {
 protected:
  void Start() {
    world_.gravity_mps2 = {0, 0, -kG};
    world_.integrator.engine = GetParam();
    dynamics_ = MakeDynamics(world_);
  }
  // Samples until `end`, and what the last of them measured.
  template <class Measured>
  Measured Last(const InstrumentSpec& spec, VirtualDuration period, VirtualTime end) {
    const auto instrument = MakeInstrument(spec, period, world_);
    const Instrument::Looks looks = instrument->looks();
    for (VirtualTime sample; sample <= end; sample = sample + period) {
      for (int look = 0; look < looks.count; ++look) {
        dynamics_->AdvanceTo(std::max(dynamics_->Now(), sample + looks.apart * look));
        instrument->Look(look, dynamics_->Now(), eyes_);
      }
    }
    return std::get<Measured>(instrument->Finish());
  }

  WorldSpec world_;
  std::unique_ptr<Dynamics> dynamics_;
  Eyes eyes_{.links =
                 [this](std::span<const int> links, std::span<LinkState> states) {
                   dynamics_->ReadLinks(dynamics_->Now(), links, states);
                 },
             .joints =
                 [this](std::span<const int> joints, std::span<JointState> states) {
                   dynamics_->ReadJoints(dynamics_->Now(), joints, states);
                 }};
};

constexpr VirtualTime At(std::int64_t ms) { return VirtualTime::FromNanoseconds(ms * 1'000'000); }

TEST_P(Instruments, AnImuAtRestFeelsG) {
  world_.models = {Block("block", {0, 0, 0.1})};
  world_.fixtures = {Fixture(PlaneShape{})};
  Start();
  const auto imu =
      Last<ImuMeasurement>(ImuSpec{{0, {{0.05, 0, 0}, {0, 0, 0, 1}}, "imu"}}, Ms(10), At(2000));
  const auto& felt = imu.felt.proper_acceleration_mps2.value();
  EXPECT_EQ(imu.frame, "imu");
  EXPECT_NEAR(felt[0], 0, 1e-3);
  EXPECT_NEAR(felt[1], 0, 1e-3);
  EXPECT_NEAR(felt[2], kG, 1e-3);
}

TEST_P(Instruments, AnImuInFreeFallFeelsNothing) {
  world_.models = {Block("block", {0, 0, 100})};
  Start();
  const auto imu = Last<ImuMeasurement>(ImuSpec{{0, {}, "imu"}}, Ms(10), At(1000));
  for (const double axis : imu.felt.proper_acceleration_mps2.value()) EXPECT_NEAR(axis, 0, 1e-6);
}

TEST_P(Instruments, AnImuOnATurntableFeelsTheCentripetalAcceleration) {
  constexpr double kRate = 6, kRadius = 0.4;
  world_.models = {Turntable(kRate)};
  Start();
  const auto imu =
      Last<ImuMeasurement>(ImuSpec{{1, {{kRadius, 0, 0}, {0, 0, 0, 1}}, "imu"}}, Ms(10), At(1000));
  const auto& felt = imu.felt.proper_acceleration_mps2.value();
  EXPECT_NEAR(felt[0], -kRate * kRate * kRadius, 1e-5);
  EXPECT_NEAR(felt[1], 0, 1e-5);
  EXPECT_NEAR(felt[2], kG, 1e-5);
  EXPECT_NEAR(imu.felt.angular_rate_radps[2], kRate, 1e-6);
}

TEST_P(Instruments, OdometryTellsTheMountsPoseAndItsVelocityAlongItsOwnAxes) {
  constexpr double kRate = 2;
  world_.models = {Turntable(kRate)};
  Start();
  TruthSpec spec;
  spec.mount.link = 1;
  spec.mount.at.position_m = {0.5, 0, 0.1};
  const auto truth = Last<OdometryMeasurement>(spec, Ms(10), At(1000));
  EXPECT_NEAR(truth.pose.position_m[0], 0.5 * std::cos(kRate), 1e-6);
  EXPECT_NEAR(truth.pose.position_m[1], 0.5 * std::sin(kRate), 1e-6);
  EXPECT_NEAR(truth.pose.position_m[2], 0.1, 1e-9);
  EXPECT_NEAR(truth.linear_mps[1], 0.5 * kRate, 1e-6);
  EXPECT_NEAR(truth.linear_mps[0], 0, 1e-6);
  EXPECT_NEAR(truth.angular_radps[2], kRate, 1e-6);
}

// How far it is from a point in a rectangular room to its walls.
double ToWalls(double x, double y, double angle, double half_x, double half_y) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double to_x = c > 0 ? (half_x - x) / c : c < 0 ? (-half_x - x) / c : kNoLimit;
  const double to_y = s > 0 ? (half_y - y) / s : s < 0 ? (-half_y - y) / s : kNoLimit;
  return std::min(to_x, to_y);
}

std::vector<Shape> Room() {
  return {Fixture(PlaneShape{}), Fixture(BoxShape{{1, 20, 4}}, {5.5, 0, 0}),
          Fixture(BoxShape{{1, 20, 4}}, {-5.5, 0, 0}), Fixture(BoxShape{{20, 1, 4}}, {0, 3.5, 0}),
          Fixture(BoxShape{{20, 1, 4}}, {0, -3.5, 0})};
}

TEST_P(Instruments, ALidarInARoomSeesItsWalls) {
  world_.models = {Block("block", {1, -0.5, 0.1})};
  world_.fixtures = Room();
  Start();
  LidarSpec lidar{{0, {{0.05, 0, 0.2}, {0, 0, 0, 1}}, "laser"}};
  lidar.rays = 720;
  lidar.last_rad = std::numbers::pi * (1 - 2.0 / 720);
  lidar.sweep = Ms(100);
  const auto scan = Last<ScanMeasurement>(lidar, Ms(100), At(500));
  ASSERT_EQ(scan.ranges_m.size(), 720u);
  for (std::size_t i = 0; i < 720; ++i) {
    const double angle = scan.first_rad + static_cast<double>(i) * scan.step_rad;
    EXPECT_NEAR(scan.ranges_m[i], ToWalls(1.05, -0.5, angle, 5, 3), 1e-6) << i;
  }
}

// The lidar turns with its table, and each ray leaves at its own instant.
TEST_P(Instruments, EachRayOfASweepLooksAtItsOwnInstant) {
  constexpr double kRate = 5;
  world_.models = {Turntable(kRate)};
  world_.fixtures = Room();
  world_.fixtures.erase(world_.fixtures.begin());
  Start();
  LidarSpec lidar{{1, {{0.5, 0, 0.3}, {0, 0, 0, 1}}, "laser"}};
  lidar.rays = 181;
  lidar.first_rad = -1.5;
  lidar.last_rad = 1.5;
  lidar.sweep = Ms(90);
  const auto scan = Last<ScanMeasurement>(lidar, Ms(100), At(300));
  EXPECT_NEAR(scan.ray_s, 0.09 / 180, 1e-12);
  for (std::size_t i = 0; i < lidar.rays; ++i) {
    const double turned = kRate * (0.3 + static_cast<double>(i) * scan.ray_s);
    const double angle = turned + scan.first_rad + static_cast<double>(i) * scan.step_rad;
    EXPECT_NEAR(scan.ranges_m[i],
                ToWalls(0.5 * std::cos(turned), 0.5 * std::sin(turned), angle, 5, 3), 1e-5)
        << i;
  }
}

TEST_P(Instruments, WhatIsOutOfReachIsAtInfinity) {
  world_.models = {Block("block", {0, 0, 0.1})};
  world_.fixtures = Room();
  Start();
  LidarSpec lidar{{0, {{0, 0, 0.2}, {0, 0, 0, 1}}, "laser"}};
  lidar.rays = 2;
  lidar.first_rad = 0;
  lidar.last_rad = std::numbers::pi / 2;
  lidar.least_m = 3.5;
  lidar.most_m = 4.5;
  const auto scan = Last<ScanMeasurement>(lidar, Ms(100), At(0));
  EXPECT_EQ(scan.ranges_m[0], kNoLimit);
  EXPECT_EQ(scan.ranges_m[1], -kNoLimit);
}

std::vector<EngineKind> EnginesWithModels() {
  std::vector<EngineKind> engines = {EngineKind::kSimbody};
#ifdef TCS_HAS_MUJOCO
  engines.push_back(EngineKind::kMujoco);
#endif
  return engines;
}

INSTANTIATE_TEST_SUITE_P(On, Instruments, testing::ValuesIn(EnginesWithModels()),
                         [](const auto& engine) {
                           return std::string(TraitsOf(engine.param).name);
                         });

}  // namespace
}  // namespace tcs
