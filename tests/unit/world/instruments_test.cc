// Sensors of robots on the engines' own motion, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coordinator/world/instruments/instrument.h"
#include "simbody_bridge/engines.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

constexpr double kG = 9.81;

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

TEST_P(Instruments, AnImuAtRestFeelsG) {
  world_.models = {Block("block", {0, 0, 0.1})};
  world_.fixtures = {Fixture(PlaneShape{})};
  Start();
  const auto imu =
      Last<ImuMeasurement>(ImuSpec{{0, {{0.05, 0, 0}, {0, 0, 0, 1}}, "imu"}}, Ms(10), AtMs(2000));
  const auto& felt = imu.felt.proper_acceleration_mps2.value();
  EXPECT_EQ(imu.frame, "imu");
  EXPECT_NEAR(felt[0], 0, 1e-3);
  EXPECT_NEAR(felt[1], 0, 1e-3);
  EXPECT_NEAR(felt[2], kG, 1e-3);
}

TEST_P(Instruments, AnImuInFreeFallFeelsNothing) {
  world_.models = {Block("block", {0, 0, 100})};
  Start();
  const auto imu = Last<ImuMeasurement>(ImuSpec{{0, {}, "imu"}}, Ms(10), AtMs(1000));
  for (const double axis : imu.felt.proper_acceleration_mps2.value()) EXPECT_NEAR(axis, 0, 1e-6);
}

TEST_P(Instruments, AnImuOnATurntableFeelsTheCentripetalAcceleration) {
  constexpr double kRate = 6, kRadius = 0.4;
  world_.models = {Turntable(kRate)};
  Start();
  const auto imu = Last<ImuMeasurement>(ImuSpec{{1, {{kRadius, 0, 0}, {0, 0, 0, 1}}, "imu"}},
                                        Ms(10), AtMs(1000));
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
  const auto truth = Last<OdometryMeasurement>(spec, Ms(10), AtMs(1000));
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
  return {Fixture(PlaneShape{}), Fixture(BoxShape{{1, 20, 10}}, {5.5, 0, 0}),
          Fixture(BoxShape{{1, 20, 10}}, {-5.5, 0, 0}), Fixture(BoxShape{{20, 1, 10}}, {0, 3.5, 0}),
          Fixture(BoxShape{{20, 1, 10}}, {0, -3.5, 0})};
}

TEST_P(Instruments, ALidarInARoomSeesItsWalls) {
  world_.models = {Block("block", {1, -0.5, 0.1})};
  world_.fixtures = Room();
  Start();
  LidarSpec lidar{{0, {{0.05, 0, 0.2}, {0, 0, 0, 1}}, "laser"}};
  lidar.rays = 720;
  lidar.last_rad = std::numbers::pi * (1 - 2.0 / 720);
  lidar.sweep = Ms(100);
  const auto scan = Last<ScanMeasurement>(lidar, Ms(100), AtMs(500));
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
  const auto scan = Last<ScanMeasurement>(lidar, Ms(100), AtMs(300));
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
  lidar.reach.least_m = 3.5;
  lidar.reach.most_m = 4.5;
  const auto scan = Last<ScanMeasurement>(lidar, Ms(100), AtMs(0));
  EXPECT_EQ(scan.ranges_m[0], kNoLimit);
  EXPECT_EQ(scan.ranges_m[1], -kNoLimit);
}

TEST_P(Instruments, ALidarWithLayersMeetsTheWallsAndTheFloor) {
  world_.models = {Block("block", {1, -0.5, 0.1})};
  world_.models[0].has_fixed_base = true;
  world_.fixtures = Room();
  Start();
  Lidar3dSpec spec;
  spec.lidar.mount.at.position_m = {0, 0, 0.4};
  spec.lidar.rays = 90;
  spec.lidar.last_rad = std::numbers::pi * (1 - 2.0 / 90);
  spec.lidar.sweep = Ms(100);
  spec.layers = 3;
  spec.lowest_rad = -0.3;
  spec.highest_rad = 0.3;
  const auto cloud = Last<CloudMeasurement>(spec, Ms(100), AtMs(500));
  ASSERT_EQ(cloud.points.size(), 270u);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto& [direction, range_m, after_s, layer] = cloud.points[i];
    EXPECT_EQ(layer, i % 3);
    EXPECT_NEAR(after_s, 0.1 * static_cast<double>(i / 3) / 89, 1e-12);
    const double angle = -std::numbers::pi + 2 * std::numbers::pi * static_cast<double>(i / 3) / 90;
    const double to_wall = ToWalls(1, -0.5, angle, 5, 3) / std::cos(0.3 * (layer - 1.0));
    const double to_floor = layer == 0 ? 0.5 / std::sin(0.3) : kNoLimit;
    EXPECT_NEAR(range_m, std::min(layer == 1 ? ToWalls(1, -0.5, angle, 5, 3) : to_wall, to_floor),
                1e-5)
        << i;
  }
}

TEST_P(Instruments, ARangeFinderSeesWhatIsNearestInItsCone) {
  world_.models = {Turntable(0)};
  // To the left of where it looks, within its cone; another one is beyond it.
  world_.fixtures = {Fixture(SphereShape{0.2}, {2, 0.2, 0}),
                     Fixture(SphereShape{0.2}, {1, 0.6, 0})};
  Start();
  RangeSpec spec;
  spec.mount.link = 1;
  spec.field_of_view_rad = 0.2;
  const auto range = Last<RangeMeasurement>(spec, Ms(100), AtMs(0));
  EXPECT_NEAR(range.range_m, std::hypot(2, 0.2) - 0.2, 1e-4);
  spec.field_of_view_rad = 0.0001;
  spec.reach.most_m = 1;
  EXPECT_EQ(Last<RangeMeasurement>(spec, Ms(100), AtMs(0)).range_m, kNoLimit);
}

TEST_P(Instruments, ADepthCameraSeesHowFarAheadThingsAre) {
  world_.models = {Turntable(0)};
  // A wall 3 m ahead, and before its upper left quarter a board at 2 m.
  world_.fixtures = {Fixture(BoxShape{{1, 20, 20}}, {3.5, 0, 0}),
                     Fixture(BoxShape{{0.1, 10, 10}}, {2.05, 5, 5})};
  Start();
  DepthCameraSpec spec;
  spec.mount.link = 1;
  spec.width = 8;
  spec.height = 6;
  const auto depth = Last<DepthMeasurement>(spec, Ms(100), AtMs(0));
  ASSERT_EQ(depth.depths_m.size(), 48u);
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 8; ++column) {
      EXPECT_NEAR(depth.depths_m[row * 8 + column], row < 3 && column < 4 ? 2 : 3, 1e-9)
          << row << ' ' << column;
    }
  }
}

TEST_P(Instruments, TheSensorsOfTheSkyAreWhereTheirMountIs) {
  world_.models = {Turntable(std::numbers::pi / 2)};
  Start();
  GnssSpec gnss;
  gnss.mount.link = 1;
  gnss.mount.at.position_m = {2, 0, 3};
  gnss.origin = {48, 11, 500};
  const auto fix = Last<GnssMeasurement>(gnss, Ms(10), AtMs(1000));
  EXPECT_NEAR(fix.enu_m[0], 0, 1e-5);
  EXPECT_NEAR(fix.enu_m[1], 2, 1e-5);
  EXPECT_NEAR(fix.position().altitude_m, 503, 1e-5);
  MagnetometerSpec magnetometer;
  magnetometer.mount.link = 1;
  magnetometer.field_t = {0, 2e-5, -4e-5};
  const auto field = Last<MagneticMeasurement>(magnetometer, Ms(10), AtMs(1000));
  EXPECT_NEAR(field.field_t[0], 2e-5, 1e-10);  // it looks to the north by now
  EXPECT_NEAR(field.field_t[1], 0, 1e-10);
  EXPECT_NEAR(field.field_t[2], -4e-5, 1e-15);
  BarometerSpec barometer;
  barometer.mount.link = 1;
  barometer.mount.at.position_m = {0, 0, 1000};
  const auto pressure = Last<PressureMeasurement>(barometer, Ms(10), AtMs(1000));
  EXPECT_NEAR(pressure.pressure_pa, 89'874.6, 1);  // ISA's table
}

TEST_P(Instruments, TransformsLeadFromTheWorldToEachLink) {
  world_.models = {Turntable(2)};
  world_.models[0].at.position_m = {1, 2, 3};
  world_.models[0].joints[0].origin.position_m = {0, 0, 0.5};
  Start();
  const TransformsSpec spec{{{-1, 0, "map", "base"}, {0, 1, "base", "table"}}};
  const auto told = Last<TransformsMeasurement>(spec, Ms(10), AtMs(1000));
  ASSERT_EQ(told.transforms.size(), 2u);
  EXPECT_EQ(told.transforms[0].frame, "map");
  EXPECT_EQ(told.transforms[0].pose.position_m, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(told.transforms[1].child_frame, "table");
  EXPECT_NEAR(told.transforms[1].pose.position_m[2], 0.5, 1e-12);
  EXPECT_NEAR(told.transforms[1].pose.orientation_xyzw[2], std::sin(1), 1e-6);
}

TEST_P(Instruments, ABumperFeelsWhatItsLinkStandsOn) {
  world_.models = {Block("block", {0, 0, 0.5})};
  world_.fixtures = {Fixture(PlaneShape{})};
  Start();
  const ContactSpec spec{};
  EXPECT_FALSE(Last<ContactMeasurement>(spec, Ms(10), AtMs(200)).is_touching);
  EXPECT_TRUE(Last<ContactMeasurement>(spec, Ms(10), AtMs(2000)).is_touching);
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

// Wheels that have turned by so much: along a straight line, on the spot, and along an arc.
TEST(WheelOdometry, IsAlongTheArcsThatTheWheelsSay) {
  WheelOdometrySpec spec;
  spec.joints = {0, 1};
  spec.base = {.separation_m = 0.5, .radius_m = 0.1};
  const auto odometry = MakeInstrument(spec, Ms(10), {});
  std::array<double, 2> turned = {7, -3};
  const Eyes eyes{.links = {}, .joints = [&](std::span<const int>, std::span<JointState> states) {
                    for (std::size_t i = 0; i < 2; ++i) states[i].position = turned[i];
                  }};
  const auto after = [&](double left, double right) {
    turned = {turned[0] + left, turned[1] + right};
    odometry->Look(0, {}, eyes);
    return std::get<OdometryMeasurement>(odometry->Finish()).pose;
  };
  EXPECT_EQ(after(0, 0).position_m, (std::array<double, 3>{}));
  EXPECT_NEAR(after(10, 10).position_m[0], 1, 1e-12);
  // A quarter of a circle to the left with a radius of 1 m.
  const double quarter = std::numbers::pi / 2;
  const Pose pose = after(0.75 * quarter / 0.1, 1.25 * quarter / 0.1);
  EXPECT_NEAR(pose.position_m[0], 2, 1e-12);
  EXPECT_NEAR(pose.position_m[1], 1, 1e-12);
  EXPECT_NEAR(pose.orientation_xyzw[2], std::sin(quarter / 2), 1e-12);
  // On the spot, half round.
  const Pose turned_round = after(-0.25 * 2 * quarter / 0.1, 0.25 * 2 * quarter / 0.1);
  EXPECT_NEAR(turned_round.position_m[1], 1, 1e-12);
  EXPECT_NEAR(turned_round.orientation_xyzw[2], std::sin(1.5 * quarter), 1e-12);
}

}  // namespace
}  // namespace tcs
