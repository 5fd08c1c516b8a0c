// Robots of the zoo in free motion: tcs, which reads their files by liburdfdom and builds them on
// both engines, and MuJoCo's own loader of URDF files move them alike.
#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "tests/unit/dynamics/test_models.h"
#include "tests/unit/engines/mujoco_robot.h"
#include "tests/unit/models/model_folder.h"
#include "tests/zoo/exercise.h"
#include "tests/zoo/free_motion.h"
#include "tests/zoo/robots.h"

namespace tcs {
namespace {

constexpr VirtualDuration kStep = VirtualDuration::Microseconds(100);
constexpr int kSteps = 5'000;
// All integrate to better than 1e-8, and are 3e-9 apart at most (measured): what is read of a file
// differs by nothing. A mass or an origin that were 1e-6 off would show.
constexpr double kWithin = 1e-7;

// Without what collides and what is seen: nothing touches here, and MuJoCo looks for meshes
// elsewhere.
std::string WithoutShapes(std::string urdf) {
  for (const std::string element : {"collision", "visual"}) {
    const std::string end = "</" + element + ">";
    for (std::size_t at; (at = urdf.find("<" + element)) != std::string::npos;) {
      urdf.erase(at, urdf.find(end, at) + end.size() - at);
    }
  }
  return urdf;
}

class LoadersAgree : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Zoo, LoadersAgree,
                         testing::Values("arm", "cobot6", "cobot7", "industrial6", "two_arms",
                                         "scara", "assistive6", "snake16", "upper15",
                                         "three_fingers8", "double_pendulum"),
                         [](const auto& robot) { return robot.param; });

TEST_P(LoadersAgree, OnFreeMotion) {
  const ModelFolder folder;
  const std::vector<zoo::Robot> all = zoo::All();
  const auto robot = std::ranges::find(all, GetParam(), &zoo::Robot::name);
  ASSERT_NE(robot, all.end());
  const zoo::LoadedRobot loaded = zoo::LoadRobot(zoo::WriteScenario(folder.Path(""), *robot));
  ASSERT_EQ(loaded.mistake, "");
  std::mt19937_64 random(3);
  const RobotModel model = zoo::SmoothModel(loaded.world.models.front(), random);

  MujocoRobot known(WithoutShapes(robot->urdf), {0, 0, -kG}, kStep.seconds());
  for (const Joint& joint : model.joints) {
    if (CoordinatesOf(joint.kind) != 1) continue;
    known.Set(joint.name, joint.initial_position[0], joint.initial_velocity[0]);
  }
  known.Advance(kSteps);

  const auto position_of = [&known](const Joint& joint) { return known.PositionOf(joint.name); };
  for (const IntegratorSpec& engine : ModelEngines()) {
    const auto [most, moved] = zoo::ApartFrom(position_of, model, engine.engine, kStep * kSteps);
    const std::string name(TraitsOf(engine.engine).name);
    std::printf("%s on %s: %.2g apart, moved by %.2g\n", GetParam(), name.c_str(), most, moved);
    EXPECT_LT(most, kWithin) << name;
    EXPECT_GT(moved, 0.1);
  }
}

}  // namespace
}  // namespace tcs
