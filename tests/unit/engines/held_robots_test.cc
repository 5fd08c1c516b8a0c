// Robots with many joints, whose own friction and damping are far stiffer than their inertia: free,
// and moved to and fro by servos, they take few steps, and the engines move them alike.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/unit/dynamics/test_models.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

constexpr int kMostMs = 1000, kEachMs = 20;

class HeldRobots : public testing::TestWithParam<const char*> {
 protected:
  static bool Moves(const Joint& joint) { return CoordinatesOf(joint.kind) == 1 && !joint.mimic; }

  static RobotModel Load() {
    const Loaded loaded = LoadFile(ZooPath(GetParam()), {true});
    EXPECT_EQ(loaded.mistake, "");
    return loaded.model;
  }

  // Each 20 ms a servo has another target, within 0.2 rad of 0, which asks for as much as its joint
  // can at first. Where the joints are at the end.
  static std::vector<double> Move(const RobotModel& model, const IntegratorSpec& engine,
                                  bool has_servos, std::int64_t most_steps) {
    const auto dynamics = MakeDynamics(WorldOf({model}, engine));
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> draw(-0.2, 0.2);
    std::vector<double> positions;
    for (int ms = 0; ms <= kMostMs; ms += kEachMs) {
      dynamics->AdvanceTo(AtMs(ms));
      positions.clear();
      for (std::size_t i = 0; i < model.joints.size(); ++i) {
        const Joint& joint = model.joints[i];
        if (!Moves(joint)) continue;
        const JointState state = ReadJoint(*dynamics, static_cast<int>(i), AtMs(ms));
        EXPECT_LT(std::abs(state.velocity), 100) << joint.name << " at " << ms << " ms";
        positions.push_back(state.position);
        if (!has_servos) continue;
        const double effort = joint.limits.effort;
        dynamics->Drive(static_cast<int>(i),
                        {.stiffness = 5 * effort,
                         .position = std::clamp(draw(random), joint.limits.lower + 0.05,
                                                joint.limits.upper - 0.05),
                         .damping = 0.2 * effort},
                        AtMs(ms));
      }
    }
    EXPECT_LE(dynamics->work().steps, most_steps) << TraitsOf(engine.engine).name;
    return positions;
  }
};

INSTANTIATE_TEST_SUITE_P(Robots, HeldRobots, testing::Values("hand.urdf", "humanoid.urdf"));

// They hang as they are: friction holds them.
TEST_P(HeldRobots, HangFreely) {
  for (const IntegratorSpec& engine : ModelEngines()) {
    for (const double position : Move(Load(), engine, false, kMostMs)) {
      EXPECT_NEAR(position, 0, 1e-3) << TraitsOf(engine.engine).name;
    }
  }
}

TEST_P(HeldRobots, FollowServosAlikeOnAllEngines) {
  const std::vector<double> first = Move(Load(), ModelEngines()[0], true, 6 * kMostMs);
  for (std::size_t i = 1; i < ModelEngines().size(); ++i) {
    const std::vector<double> other = Move(Load(), ModelEngines()[i], true, kMostMs);
    ASSERT_EQ(first.size(), other.size());
    for (std::size_t joint = 0; joint < first.size(); ++joint) {
      EXPECT_NEAR(first[joint], other[joint], 5e-3) << joint;
    }
  }
}

// Fingers overlap the palm that they hang on.
TEST_P(HeldRobots, FollowServosThoughTheyTouchThemselves) {
  RobotModel model = Load();
  model.has_self_collision = true;
  for (const IntegratorSpec& engine : ModelEngines()) Move(model, engine, true, 6 * kMostMs);
}

}  // namespace
}  // namespace tcs
