// An arm and a quadruped in free motion under random efforts: the engines of tcs, which build them
// from its model of them, and DART, which reads their files by itself, move them alike.
#include <algorithm>
#include <cmath>
#include <random>

#include "simbody_bridge/model/rigid_tree.h"
#include "tests/unit/dynamics/test_models.h"
#include "tests/unit/engines/dart_robot.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

constexpr double kWithinRad = 1e-4, kWithinM = 1e-4;
constexpr int kPieces = 50;
constexpr std::int64_t kPieceMs = 20;  // an effort acts so long

struct Efforts {
  std::vector<std::vector<double>> pieces;  // by the joints of the model
};

// Shares of what each joint can take, which is within its limit.
Efforts DrawEfforts(const RobotModel& model, double share, std::mt19937_64& random) {
  std::uniform_real_distribution<double> draw(-share, share);
  Efforts efforts;
  for (int piece = 0; piece < kPieces; ++piece) {
    std::vector<double>& of_joints = efforts.pieces.emplace_back();
    for (const Joint& joint : model.joints) {
      of_joints.push_back(joint.kind == JointKind::kFixed ? 0 : draw(random) * joint.limits.effort);
    }
  }
  return efforts;
}

// Without what is not smooth: its stops, Coulomb's friction, and its shapes.
RobotModel SmoothModel(const std::string& file, bool has_fixed_base) {
  const Loaded loaded = LoadFile(ZooPath(file), {has_fixed_base});
  EXPECT_EQ(loaded.mistake, "");
  RobotModel model = loaded.model;
  for (Link& link : model.links) link.shapes.clear();
  for (Joint& joint : model.joints) {
    joint.friction = 0;
    joint.limits.lower = -kNoLimit;
    joint.limits.upper = kNoLimit;
  }
  return model;
}

void DrawStart(RobotModel* model, std::mt19937_64& random) {
  std::uniform_real_distribution<double> draw(-1, 1);
  for (Joint& joint : model->joints) {
    if (joint.kind == JointKind::kFixed) continue;
    joint.initial_position = {draw(random)};
    joint.initial_velocity = {draw(random)};
  }
  model->at.position_m = {draw(random), draw(random), draw(random)};
  model->at.orientation_xyzw = Normalised({draw(random), draw(random), draw(random), draw(random)});
  if (model->has_fixed_base) return;
  model->linear_velocity_mps = {draw(random), draw(random), draw(random)};
  model->angular_velocity_radps = {draw(random), draw(random), draw(random)};
}

// The angle by which one is turned beside the other.
double AngleBetween(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  const auto turn = Times(std::array{-a[0], -a[1], -a[2], a[3]}, b);
  return 2 * std::atan2(std::hypot(turn[0], turn[1], turn[2]), std::abs(turn[3]));
}

struct Snapshot {
  std::vector<double> joints;  // of those that move, in the order of the model
  std::vector<Pose> links;
};

// How it is at the end of each piece.
using Motion = std::vector<Snapshot>;

Motion MotionOn(const IntegratorSpec& engine, const RobotModel& model, const Efforts& efforts) {
  IntegratorSpec spec = engine;
  spec.accuracy = 1e-8;
  if (spec.engine == EngineKind::kMujoco) spec.fixed_step = VirtualDuration::Microseconds(500);
  auto dynamics = MakeDynamics(WorldOf({model}, spec));
  Motion motion;
  for (int piece = 0; piece < kPieces; ++piece) {
    const VirtualTime from = AtMs(piece * kPieceMs), to = AtMs((piece + 1) * kPieceMs);
    Snapshot& at_end = motion.emplace_back();
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      if (model.joints[i].kind == JointKind::kFixed) continue;
      dynamics->Drive(static_cast<int>(i),
                      {.effort = efforts.pieces[static_cast<std::size_t>(piece)][i]}, from);
    }
    dynamics->AdvanceTo(to);
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      if (model.joints[i].kind == JointKind::kFixed) continue;
      at_end.joints.push_back(ReadJoint(*dynamics, static_cast<int>(i), to).position);
    }
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      at_end.links.push_back(ReadLink(*dynamics, static_cast<int>(i), to).pose);
    }
  }
  return motion;
}

Motion MotionOnDart(const std::string& file, const RobotModel& model, const Efforts& efforts) {
  DartRobot robot(ZooPath(file), ZooPath(""), model, {0, 0, -kG});
  Motion motion;
  for (int piece = 0; piece < kPieces; ++piece) {
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      if (model.joints[i].kind == JointKind::kFixed) continue;
      robot.SetEffort(model.joints[i].name, efforts.pieces[static_cast<std::size_t>(piece)][i]);
    }
    robot.Advance(1e-3 * kPieceMs, 40);
    Snapshot& at_end = motion.emplace_back();
    for (const Joint& joint : model.joints) {
      if (joint.kind != JointKind::kFixed) at_end.joints.push_back(robot.PositionOf(joint.name));
    }
    for (const Link& link : model.links) at_end.links.push_back(robot.PoseOf(link.name));
  }
  return motion;
}

struct Difference {
  double joints_rad = 0, links_rad = 0, links_m = 0;
};
Difference Between(const Motion& a, const Motion& b) {
  Difference most;
  for (std::size_t piece = 0; piece < a.size(); ++piece) {
    for (std::size_t i = 0; i < a[piece].joints.size(); ++i) {
      const double apart = std::abs(a[piece].joints[i] - b[piece].joints[i]);
      most.joints_rad = std::max(most.joints_rad, apart);
    }
    for (std::size_t i = 0; i < a[piece].links.size(); ++i) {
      const Pose &one = a[piece].links[i], &other = b[piece].links[i];
      const auto &p = one.position_m, &q = other.position_m;
      most.links_rad =
          std::max(most.links_rad, AngleBetween(one.orientation_xyzw, other.orientation_xyzw));
      most.links_m = std::max(most.links_m, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
  }
  return most;
}

// Each joint has turned by more than the bound that is tested, by far.
void ExpectToHaveMoved(const Motion& motion) {
  const std::vector<double>& first = motion.front().joints;
  for (std::size_t i = 0; i < first.size(); ++i) {
    double most = 0;
    for (const Snapshot& at : motion) most = std::max(most, std::abs(at.joints[i] - first[i]));
    EXPECT_GT(most, 0.1) << "joint " << i;
  }
}

struct Robot {
  const char* name;
  const char* file;
  bool has_fixed_base;
  double share;  // of the joints' limits of effort
};
void PrintTo(const Robot& robot, std::ostream* out) { *out << robot.file; }

class EnginesAgree : public testing::TestWithParam<Robot> {};

INSTANTIATE_TEST_SUITE_P(Robots, EnginesAgree,
                         testing::Values(Robot{"Arm", "zoo_description/urdf/arm.urdf", true, 0.05},
                                         Robot{"Quadruped", "quadruped.urdf", false, 0.05}),
                         [](const auto& robot) { return robot.param.name; });

TEST_P(EnginesAgree, OnFreeMotionUnderRandomEfforts) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    std::mt19937_64 random(seed);
    RobotModel model = SmoothModel(GetParam().file, GetParam().has_fixed_base);
    DrawStart(&model, random);
    const Efforts efforts = DrawEfforts(model, GetParam().share, random);
    const Motion known = MotionOnDart(GetParam().file, model, efforts);
    ExpectToHaveMoved(known);
    for (const IntegratorSpec& engine : ModelEngines()) {
      const Difference most = Between(MotionOn(engine, model, efforts), known);
      EXPECT_LT(most.joints_rad, kWithinRad) << TraitsOf(engine.engine).name << ", seed " << seed;
      EXPECT_LT(most.links_rad, kWithinRad) << TraitsOf(engine.engine).name << ", seed " << seed;
      EXPECT_LT(most.links_m, kWithinM) << TraitsOf(engine.engine).name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace tcs
