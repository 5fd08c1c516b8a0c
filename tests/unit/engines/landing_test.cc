// What lands stays down, at whatever speed it comes, and without going deep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/dynamics/test_models.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

class Landing : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, Landing, testing::ValuesIn(ModelEngines()), NameOfEngine);

RobotModel Resting(const Geometry& geometry, double moment_kgm2) {
  return Loose("it", geometry, {{0, 0, 0.1}, {0, 0, 0, 1}}, 1, 0.8, moment_kgm2);
}

struct Course {
  double leaving_mps = 0;  // at the most, once it was down
  double depth_m = 0;      // at the most
  double end_m = 0;        // above where it rests
};

// `model`, placed as it rests, comes down on a floor from `height_m` above it.
Course CourseOf(RobotModel model, double height_m, double speed_mps, const IntegratorSpec& engine) {
  const double rest_m = model.at.position_m[2];
  model.at.position_m[2] += height_m;
  model.linear_velocity_mps = {0, 0, -speed_mps};
  WorldSpec world = WorldOf({model}, engine);
  world.fixtures = {{.geometry = PlaneShape{}, .friction = 0.8}};
  auto dynamics = MakeDynamics(world);
  Course course;
  bool is_down = false;
  for (int ms = 1; ms <= 600; ++ms) {
    const LinkState state = ReadLink(*dynamics, 0, AtMs(ms));
    course.end_m = state.pose.position_m[2] - rest_m;
    course.depth_m = std::max(course.depth_m, -course.end_m);
    is_down = is_down || course.end_m < 0;
    if (is_down) course.leaving_mps = std::max(course.leaving_mps, state.linear_velocity_mps[2]);
  }
  EXPECT_TRUE(is_down);
  return course;
}

// Steps of contact begin at any place before the touch: so it falls from several heights.
TEST_P(Landing, NothingBounces) {
  const bool is_simbody = GetParam().engine == EngineKind::kSimbody;
  const Loaded rover = LoadFile(ZooPath("rover.urdf"));
  ASSERT_EQ(rover.mistake, "");
  const std::pair<const char*, RobotModel> all[] = {
      {"ball", Resting(SphereShape{0.1}, 0.004)},
      {"box", Resting(BoxShape{{0.2, 0.2, 0.2}}, 1.0 / 150)},
      {"cylinder", Resting(CylinderShape{0.1, 0.2}, 1.0 / 150)},
      {"rover", rover.model}};
  for (const auto& [name, model] : all) {
    for (const double speed : {0.1, 1.0, 3.0, 10.0, 17.0, 30.0}) {
      for (const double share : {0.0, 0.3, 0.7}) {
        const Course course = CourseOf(model, 0.02 + share * speed * 1e-3, speed, GetParam());
        const std::string what = std::string(name) + " at " + std::to_string(speed) + " m/s";
        // Simbody: at 5 cm/s, whatever it came at. MuJoCo: at a sixth of what it came at.
        const double at_floor = std::sqrt(speed * speed + 2 * kG * 0.02);
        EXPECT_LT(course.leaving_mps, is_simbody ? 0.05 : at_floor / 6) << what;
        EXPECT_LT(course.depth_m, is_simbody ? 1.5e-3 : 2e-3 + speed * 4e-3) << what;
        // Nor is it held where it is deep.
        if (is_simbody) {
          EXPECT_NEAR(course.end_m, 0, 1e-4) << what;
        }
      }
    }
  }
}

}  // namespace
}  // namespace tcs
