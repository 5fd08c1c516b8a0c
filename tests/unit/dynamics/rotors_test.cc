// Rotors, and joints that are driven with a lag: against closed forms, and taken back.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "tests/unit/dynamics/taken_back.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

constexpr double kCraftKg = 2, kCraftMoment = 0.02;
constexpr double kRotorThrust = 1e-5, kRotorDrag = 2e-7;
constexpr VirtualDuration kRotorLag = VirtualDuration::Milliseconds(50);
constexpr double kRotorLagS = 0.05;

Rotor RotorAt(const std::string& name, const Pose& frame) {
  Rotor rotor;
  rotor.name = name;
  rotor.link = 0;
  rotor.frame = frame;
  rotor.thrust_ns2 = kRotorThrust;
  rotor.drag_nms2 = kRotorDrag;
  rotor.time_constant = kRotorLag;
  rotor.most_radps = 1000;
  return rotor;
}

// A free base with these rotors, without gravity.
WorldSpec Craft(std::vector<Rotor> rotors, IntegratorSpec integrator) {
  RobotModel model;
  model.name = "craft";
  model.links.push_back(LinkOf("base", MassAt(kCraftKg, {}, kCraftMoment)));
  model.rotors = std::move(rotors);
  integrator.accuracy = 1e-9;
  WorldSpec world = WorldOf({model}, integrator);
  world.gravity_mps2 = {};
  return world;
}

// The square of the speed, added up over `t` seconds from a command for `to` on, when the rotor
// has turned with `from`.
double SquareOverTime(double from, double to, double t) {
  const double missing = from - to;
  return to * to * t - 2 * to * missing * kRotorLagS * std::expm1(-t / kRotorLagS) -
         missing * missing * kRotorLagS / 2 * std::expm1(-2 * t / kRotorLagS);
}
double SpeedAfter(double from, double to, double t) {
  return to + (from - to) * std::exp(-t / kRotorLagS);
}

class Rotors : public EveryModelEngine {};
INSTANTIATE_TEST_SUITE_P(Dynamics, Rotors, testing::ValuesIn(ModelEngines()), NameOfEngine);

TEST_P(Rotors, ThrustComesWithTheTimeConstantAndGoesAlongTheLink) {
  // Lies on its side: the rotor pushes along the world's x.
  WorldSpec world = Craft({RotorAt("only", {})}, GetParam());
  world.models[0].rotors[0].drag_nms2 = 0;
  const double r = std::sqrt(0.5);
  world.models[0].at.orientation_xyzw = {0, r, 0, r};
  auto dynamics = MakeDynamics(world);
  constexpr std::int64_t kUpNs = 12'345'678, kDownNs = 212'000'001;
  dynamics->Spin(0, 800, At(kUpNs));
  dynamics->Spin(0, 300, At(kDownNs));
  const double whole = 1e-9 * (kDownNs - kUpNs);
  const double fastest = SpeedAfter(0, 800, whole);
  for (int ms = 1; ms <= 600; ++ms) {
    const double up = std::min(whole, std::max(0.0, 1e-3 * ms - 1e-9 * kUpNs));
    const double down = std::max(0.0, 1e-3 * ms - 1e-9 * kDownNs);
    const double square = SquareOverTime(0, 800, up) + SquareOverTime(fastest, 300, down);
    const LinkState state = ReadLink(*dynamics, 0, AtMs(ms));
    ASSERT_NEAR(state.linear_velocity_mps[0], kRotorThrust / kCraftKg * square, 1e-7) << ms;
    ASSERT_NEAR(state.linear_velocity_mps[2], 0, 1e-9) << ms;
  }
}

TEST_P(Rotors, DragTurnsTheLinkAgainstTheWayThatTheRotorTurns) {
  for (const bool is_clockwise : {false, true}) {
    WorldSpec world = Craft({RotorAt("only", {})}, GetParam());
    world.models[0].rotors[0].is_clockwise = is_clockwise;
    auto dynamics = MakeDynamics(world);
    dynamics->Spin(0, 500, AtMs(0));
    const double turned =
        (is_clockwise ? 1 : -1) * kRotorDrag / kCraftMoment * SquareOverTime(0, 500, 0.3);
    EXPECT_NEAR(ReadLink(*dynamics, 0, AtMs(300)).angular_velocity_radps[2], turned, 1e-7);
  }
}

// Mounted away from the centre and tilted: its thrust along the link's y turns the link about z.
TEST_P(Rotors, PushWhereAndAsTheyAreMounted) {
  const double r = std::sqrt(0.5);
  WorldSpec world = Craft({RotorAt("side", {{0.2, 0, 0}, {-r, 0, 0, r}})}, GetParam());
  world.models[0].rotors[0].drag_nms2 = 0;
  auto dynamics = MakeDynamics(world);
  dynamics->Spin(0, 400, AtMs(0));
  const double turned = 0.2 * kRotorThrust / kCraftMoment * SquareOverTime(0, 400, 0.2);
  const LinkState state = ReadLink(*dynamics, 0, AtMs(200));
  EXPECT_NEAR(state.angular_velocity_radps[2], turned, 1e-7);
  EXPECT_NEAR(state.angular_velocity_radps[0], 0, 1e-9);
}

TEST_P(Rotors, WithoutATimeConstantTurnAtOnce) {
  WorldSpec world = Craft({RotorAt("only", {})}, GetParam());
  world.models[0].rotors[0].time_constant = {};
  auto dynamics = MakeDynamics(world);
  dynamics->Spin(0, 100, At(50'000'001));
  EXPECT_NEAR(ReadLink(*dynamics, 0, At(150'000'001)).linear_velocity_mps[2],
              kRotorThrust / kCraftKg * 100 * 100 * 0.1, 1e-12);
}

TEST_P(Rotors, OfEachModelAreItsOwn) {
  WorldSpec world = Craft({RotorAt("a", {}), RotorAt("b", {})}, GetParam());
  world.models.push_back(world.models[0]);
  world.models[1].name = "other";
  world.models[1].at.position_m = {0, 0, 9};
  auto dynamics = MakeDynamics(world);
  const int rotor = *dynamics->FindRotor("other", "b");
  EXPECT_EQ(rotor, 3);
  EXPECT_FALSE(dynamics->FindRotor("other", "c").has_value());
  dynamics->Spin(rotor, 400, AtMs(0));
  EXPECT_EQ(ReadLink(*dynamics, 0, AtMs(100)).linear_velocity_mps[2], 0);
  EXPECT_GT(ReadLink(*dynamics, 1, AtMs(100)).linear_velocity_mps[2], 1e-3);
}

TEST_P(Rotors, RefuseASpeedThatTheyDoNotHave) {
  auto dynamics = MakeDynamics(Craft({RotorAt("only", {})}, GetParam()));
  for (const double speed : {-1.0, 1000.1, std::nan("")}) {
    try {
      dynamics->Spin(0, speed, AtMs(0));
      FAIL() << speed;
    } catch (const DynamicsError& error) {
      EXPECT_STREQ(error.what(), "rotor 'only': its speed must be between 0 and 1000 rad/s");
    }
  }
}

TEST_P(Rotors, ThatCannotBeAreRefusedByName) {
  const auto refused = [](auto&& change) -> std::string {
    WorldSpec world = Craft({RotorAt("only", {})}, GetParam());
    change(world.models[0].rotors);
    try {
      MakeDynamics(world);
      return "taken";
    } catch (const DynamicsError& error) {
      return error.what();
    }
  };
  using All = std::vector<Rotor>;
  EXPECT_EQ(refused([](All& all) { all[0].link = 1; }),
            "model 'craft': rotor 'only': its link is no link of the model");
  EXPECT_EQ(refused([](All& all) { all[0].drag_nms2 = -1; }),
            "model 'craft': rotor 'only': its thrust and its drag must be finite and not negative");
  EXPECT_EQ(refused([](All& all) { all[0].most_radps = 0; }),
            "model 'craft': rotor 'only': the most of its speed must be positive");
  EXPECT_EQ(refused([](All& all) { all.push_back(all[0]); }),
            "model 'craft': two rotors are named 'only'");
}

// What drives a joint goes over from one command to the next: an effort exactly so, and a servo's
// by what it would give where the joint is.
TEST_P(Rotors, JointsCanBeDrivenWithALag) {
  RobotModel model = Pendulum(1);
  model.joints[0].drive_lag = kRotorLag;
  WorldSpec world = WorldOf({model}, GetParam());
  world.gravity_mps2 = {};
  world.integrator.accuracy = 1e-9;
  auto dynamics = MakeDynamics(world);
  constexpr double kInertia = 1.01;
  dynamics->Drive(0, {.effort = 2}, AtMs(10));
  const JointState state = ReadJoint(*dynamics, 0, AtMs(70));
  EXPECT_NEAR(state.effort, 2 * -std::expm1(-0.06 / kRotorLagS), 1e-12);
  EXPECT_NEAR(state.velocity, 2 / kInertia * (0.06 + kRotorLagS * std::expm1(-0.06 / kRotorLagS)),
              1e-7);
  dynamics->AdvanceTo(AtMs(70));
  dynamics->Drive(0, {.stiffness = 10, .position = 1, .damping = 3}, AtMs(70));
  const JointState later = ReadJoint(*dynamics, 0, AtMs(90));
  const double left = std::exp(-0.02 / kRotorLagS);
  EXPECT_NEAR(later.effort,
              left * state.effort + (1 - left) * (10 * (1 - later.position) - 3 * later.velocity),
              1e-9);
}

// A craft with a driven joint that flies and bumps on a floor, read ahead of the commands by up to
// 40 ms, with checkpoints and branches from them.
TEST_P(Rotors, AreTakenBackToTheByte) {
  RobotModel model = Pendulum(1, 0.2, 0.3, 0.002);
  model.name = "craft";
  model.has_fixed_base = false;
  model.at.position_m = {0, 0, 0.35};
  model.links[0].inertial = MassAt(1, {}, 0.02);
  model.links[0].shapes.push_back({.name = "hull", .geometry = BoxShape{{0.3, 0.3, 0.1}}});
  model.joints[0].drive_lag = VirtualDuration::Milliseconds(7);
  model.rotors = {RotorAt("left", {{0, 0.2, 0}, {0, 0, 0, 1}}),
                  RotorAt("right", {{0, -0.2, 0}, {0, 0, 0, 1}})};
  model.rotors[1].is_clockwise = true;
  WorldSpec world = WorldOf({model}, GetParam());
  world.fixtures.push_back({.name = "floor", .geometry = PlaneShape{}});
  auto known = MakeDynamics(world);
  auto leading = MakeDynamics(world);
  std::mt19937_64 random(5);
  const auto draw = [&](std::uint64_t below) {
    return static_cast<std::int64_t>(random() % below);
  };
  struct Timed {
    std::int64_t at_ns;
    int rotor;  // or the joint
    double value;
  };
  std::vector<Timed> commands;
  std::int64_t at_ns = 0;
  for (int i = 0; i < 1000; ++i) {
    if (draw(5) != 0) at_ns += 1 + draw(6'000'000);
    commands.push_back({at_ns, static_cast<int>(draw(3)), static_cast<double>(draw(1000))});
  }
  const auto apply = [](Dynamics& dynamics, const Timed& command) {
    if (command.rotor < 2) {
      dynamics.Spin(command.rotor, command.value, At(command.at_ns));
    } else {
      dynamics.Drive(
          0, {.effort = 0.1, .stiffness = 1, .position = 1e-3 * command.value, .damping = 0.1},
          At(command.at_ns));
    }
  };
  struct All {
    std::array<LinkState, 2> links;
    JointState joint;
  };
  const auto read = [](Dynamics& dynamics, std::int64_t ns) {
    All all;
    dynamics.ReadLinks(At(ns), std::array{0, 1}, all.links);
    all.joint = ReadJoint(dynamics, 0, At(ns));
    return all;
  };
  ASSERT_NO_FATAL_FAILURE(ExpectTheSameToTheByte(*known, *leading, commands, apply, read, draw));
}

}  // namespace
}  // namespace tcs
