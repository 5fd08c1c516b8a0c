// Models that come near each other, and part.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

class ModelsThatMeet : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, ModelsThatMeet, testing::ValuesIn(ModelEngines()), NameOfEngine);

constexpr double kFriction = 0.5;

RobotModel Moving(const std::string& name, const Geometry& geometry,
                  const std::array<double, 3>& at_m,
                  const std::array<double, 3>& velocity_mps = {}) {
  RobotModel model = Loose(name, geometry, {at_m, {0, 0, 0, 1}}, 1, kFriction);
  model.linear_velocity_mps = velocity_mps;
  return model;
}

const Geometry kBall = SphereShape{0.1};
const Geometry kBox = BoxShape{{0.2, 0.3, 0.2}};

std::vector<LinkState> ReadAllLinks(Dynamics& dynamics, int count, VirtualTime t) {
  std::vector<int> links(static_cast<std::size_t>(count));
  std::iota(links.begin(), links.end(), 0);
  std::vector<LinkState> states(links.size());
  dynamics.ReadLinks(t, links, states);
  return states;
}

bool SameBits(const std::vector<LinkState>& a, const std::vector<LinkState>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(LinkState)) == 0;
}

void ExpectNear(const LinkState& a, const LinkState& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(a.pose.position_m[i], b.pose.position_m[i], tolerance);
    EXPECT_NEAR(a.linear_velocity_mps[i], b.linear_velocity_mps[i], tolerance);
    EXPECT_NEAR(a.angular_velocity_radps[i], b.angular_velocity_radps[i], 10 * tolerance);
  }
}

WorldSpec InSpace(std::vector<RobotModel> models, const IntegratorSpec& spec) {
  WorldSpec world = WorldOf(std::move(models), spec);
  world.gravity_mps2 = {};
  return world;
}

// A ball hits a box off its centre.
WorldSpec Collision(const IntegratorSpec& spec) {
  return InSpace(
      {Moving("ball", kBall, {-4, 0.05, 0}, {1, 0, 0}), Moving("box", kBox, {4, 0, 0}, {-1, 0, 0})},
      spec);
}

// How far they may come apart by how a step of 1 ms of first order lies to the instant of contact:
// MuJoCo's steps lie alike, those of Simbody do not.
double ToleranceOf(const IntegratorSpec& spec) {
  const bool lie_alike = spec.engine == EngineKind::kMujoco || spec.fixed_step > VirtualDuration{};
  return lie_alike ? 1e-6 : 0.01;
}

void ExpectToCollideAsInOneIsland(const IntegratorSpec& spec) {
  WorldSpec world = Collision(spec);
  auto meeting = MakeDynamics(world);
  world.models_together = {{1, 0}};
  auto together = MakeDynamics(world);
  EXPECT_EQ(together->island_count(), 1);
  const double closing_mps = 2, contact_s = 3.9;
  for (const auto& [ms, islands] :
       {std::pair{1000, 2}, {3600, 2}, {3950, 1}, {4500, 1}, {7000, 2}}) {
    const auto a = ReadAllLinks(*meeting, 2, AtMs(ms)), b = ReadAllLinks(*together, 2, AtMs(ms));
    EXPECT_EQ(meeting->island_count(), islands) << ms;
    const double since_s = std::max(1.0, ms / 1000.0 - contact_s);
    for (std::size_t i = 0; i < 2; ++i) {
      ExpectNear(a[i], b[i], ToleranceOf(spec) * closing_mps * since_s);
    }
    meeting->AdvanceTo(AtMs(ms));
  }
  EXPECT_EQ(together->work().regrouped, 0);
  const auto end = ReadAllLinks(*meeting, 2, AtMs(7000));
  EXPECT_LT(end[0].linear_velocity_mps[0], 0.2) << "the ball was stopped";
  EXPECT_GT(std::abs(end[1].angular_velocity_radps[2]), 0.1) << "the box was turned";
}

TEST_P(ModelsThatMeet, CollideAsTheyDoInOneIsland) {
  ExpectToCollideAsInOneIsland(GetParam());
  IntegratorSpec with_steps = GetParam();
  with_steps.fixed_step = VirtualDuration::Microseconds(500);
  ExpectToCollideAsInOneIsland(with_steps);
}

TEST_P(ModelsThatMeet, MoveTheSameWhoeverIsReadAndWhen) {
  const WorldSpec world = Collision(GetParam());
  auto at_once = MakeDynamics(world);
  auto ball_first = MakeDynamics(world);
  auto stepwise = MakeDynamics(world);
  for (std::int64_t ms = 3; ms <= 5000; ms += 11) {
    (void)ReadLink(*ball_first, 0, AtMs(ms));
    if (ms % 5 == 0) (void)ReadLink(*stepwise, ms % 2, AtMs(ms));
    if (ms % 3 == 0) stepwise->AdvanceTo(AtMs(ms));
  }
  const auto a = ReadAllLinks(*at_once, 2, AtMs(5003));
  EXPECT_TRUE(SameBits(a, ReadAllLinks(*ball_first, 2, AtMs(5003))));
  EXPECT_TRUE(SameBits(a, ReadAllLinks(*stepwise, 2, AtMs(5003))));
}

TEST_P(ModelsThatMeet, PartAgainWhereTheMeetingIsTakenBack) {
  const WorldSpec world = Collision(GetParam());
  auto known = MakeDynamics(world);
  auto leading = MakeDynamics(world);
  // A push to the side, early enough that they miss each other.
  const Wrench push{.force_n = {0, 6, 0}};
  known->ApplyToLink(0, WrenchFrame::kWorld, push, AtMs(3500));
  leading->AdvanceTo(AtMs(3500));
  (void)ReadLink(*leading, 0, AtMs(3950));
  EXPECT_EQ(leading->island_count(), 1);
  const auto checkpoint = leading->Save();
  leading->ApplyToLink(0, WrenchFrame::kWorld, push, AtMs(3500));
  EXPECT_EQ(leading->island_count(), 2);
  const auto missed = ReadAllLinks(*known, 2, AtMs(5000));
  EXPECT_TRUE(SameBits(missed, ReadAllLinks(*leading, 2, AtMs(5000))));
  EXPECT_NEAR(missed[1].linear_velocity_mps[0], -1, 1e-9) << "nobody touched it";
  leading->Restore(*checkpoint);
  EXPECT_LT(ReadLink(*leading, 0, AtMs(5000)).linear_velocity_mps[0], 0.2) << "they hit";
  leading->Restore(*checkpoint);
  leading->ApplyToLink(0, WrenchFrame::kWorld, push, AtMs(3500));
  EXPECT_TRUE(SameBits(missed, ReadAllLinks(*leading, 2, AtMs(5000))));
}

// Four that are driven back and forth between each other, on a floor: read ahead of the commands,
// taken back, saved and restored.
WorldSpec FourOnAFloor(const IntegratorSpec& spec) {
  WorldSpec world = WorldOf({}, spec);
  world.fixtures = {ShapeOf(PlaneShape{}, kFriction)};
  for (int i = 0; i < 4; ++i) {
    world.models.push_back(
        Moving("m" + std::to_string(i), i % 2 == 0 ? kBall : kBox, {0.8 * i, 0.1 * i, 0.1}));
  }
  return world;
}

void ExpectToBeTakenBackToTheByte(const WorldSpec& world) {
  auto known = MakeDynamics(world);
  auto leading = MakeDynamics(world);
  std::mt19937_64 random(7);
  const auto draw = [&](std::uint64_t below) {
    return static_cast<std::int64_t>(random() % below);
  };
  struct Timed {
    std::int64_t at_ns;
    int link;
    Wrench wrench;
  };
  std::vector<Timed> commands;
  std::int64_t at_ns = 0;
  for (int i = 0; i < 300; ++i) {
    if (draw(4) != 0) at_ns += 1 + draw(20'000'000);
    const int link = static_cast<int>(draw(4));
    // Towards the middle more often than away from it.
    const double push = (link < 2 ? 1.0 : -1.0) * (static_cast<double>(draw(16)) - 5);
    commands.push_back({at_ns, link, {.force_n = {push, 0.1 * push, 0}}});
  }
  const auto apply = [](Dynamics& dynamics, const Timed& of) {
    dynamics.ApplyToLink(of.link, WrenchFrame::kWorld, of.wrench, At(of.at_ns));
  };
  for (const Timed& command : commands) apply(*known, command);
  std::unique_ptr<Dynamics::Checkpoint> checkpoint;
  int most = 0, least = 99;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::int64_t now_ns = commands[i].at_ns;
    known->AdvanceTo(At(now_ns));
    leading->AdvanceTo(At(now_ns));
    ASSERT_TRUE(
        SameBits(ReadAllLinks(*known, 4, At(now_ns)), ReadAllLinks(*leading, 4, At(now_ns))))
        << "before command " << i << " at " << now_ns;
    most = std::max(most, known->island_count());
    least = std::min(least, known->island_count());
    (void)ReadLink(*leading, static_cast<int>(draw(4)), At(now_ns + draw(150'000'000)));
    if (draw(8) == 0) checkpoint = leading->Save(std::move(checkpoint));
    apply(*leading, commands[i]);
    if (checkpoint != nullptr && draw(8) == 0) {
      leading->Restore(*checkpoint);
      const VirtualTime from = leading->Now();
      std::size_t first = i + 1;
      while (first > 0 && At(commands[first - 1].at_ns) >= from) --first;
      for (std::size_t k = first; k <= i; ++k) apply(*leading, commands[k]);
    }
  }
  const int alone = static_cast<int>(world.models.size()) - 4;
  EXPECT_EQ(most, 4 + alone);
  EXPECT_LE(least, 2 + alone) << "they met";
  EXPECT_GT(known->work().regrouped, 10);
  EXPECT_GT(leading->work().regrouped, known->work().regrouped) << "meetings were taken back";
  EXPECT_GT(leading->work().taken_back, 100);
}

TEST_P(ModelsThatMeet, AreTakenBackToTheByte) {
  ExpectToBeTakenBackToTheByte(FourOnAFloor(GetParam()));
}

// A model that is one shape and does not move.
RobotModel Standing(const std::string& name, const Geometry& geometry,
                    const std::array<double, 3>& at_m) {
  RobotModel model = Moving(name, geometry, at_m);
  model.has_fixed_base = true;
  return model;
}

TEST_P(ModelsThatMeet, AreTakenBackToTheByteAmongWhatStands) {
  WorldSpec world = FourOnAFloor(GetParam());
  world.models.push_back(Standing("north", kBox, {1.2, 0.7, 0.1}));
  world.models.push_back(Standing("south", kBox, {1.2, -0.4, 0.1}));
  ExpectToBeTakenBackToTheByte(world);
}

// From a standstill through 3 m in 0.17 s: much harder than zones trust.
TEST_P(ModelsThatMeet, AreNotMissedHoweverHardTheyArePushed) {
  WorldSpec world = InSpace({Moving("hammer", kBall, {0, 0, 0}), Moving("nail", kBox, {3, 0, 0}),
                             Moving("wall", kBox, {0, 30, 0})},
                            GetParam());
  const auto strike = [&] {
    auto dynamics = MakeDynamics(world);
    dynamics->ApplyToLink(0, WrenchFrame::kLink, {.force_n = {200, 0, 0}}, AtMs(100));
    return ReadAllLinks(*dynamics, 3, AtMs(400));
  };
  const auto meeting = strike();
  world.models_together = {{0, 1, 2}};
  const auto together = strike();
  for (std::size_t i = 0; i < 3; ++i) {
    ExpectNear(meeting[i], together[i], 0.05);
  }
  EXPECT_GT(meeting[1].linear_velocity_mps[0], 5) << "the nail was struck";
}

TEST_P(ModelsThatMeet, AFloorJoinsNobody) {
  const auto stand = [&](int count) {
    WorldSpec world = WorldOf({}, GetParam());
    world.fixtures = {ShapeOf(PlaneShape{}, kFriction)};
    for (int i = 0; i < count; ++i) {
      world.models.push_back(Moving("robot" + std::to_string(i), kBox, {1.0 * i, 0, 0.11}));
    }
    auto dynamics = MakeDynamics(world);
    const auto states = ReadAllLinks(*dynamics, count, AtMs(500));
    EXPECT_EQ(dynamics->island_count(), count);
    for (const LinkState& state : states) EXPECT_NEAR(state.pose.position_m[2], 0.1, 1e-3);
    EXPECT_TRUE(std::all_of(states.begin(), states.end(), [&](const LinkState& state) {
      return state.pose.position_m[2] == states[0].pose.position_m[2];
    })) << "each stands as it would alone";
    return dynamics->work().steps;
  };
  const std::int64_t one = stand(1);
  // Zones may shorten a step of those that fall.
  EXPECT_LE(stand(30), 30 * (one + 5));
}

// What stands on it moves as on the world's own, each by itself.
TEST_P(ModelsThatMeet, ATableJoinsNobody) {
  const Geometry plate = BoxShape{{3, 1, 0.1}};
  WorldSpec world =
      WorldOf({Standing("table", plate, {0, 0, 0.45}), Moving("left", kBox, {-1, 0, 0.61}),
               Moving("right", kBox, {1, 0, 0.61}, {2, 0, 0})},
              GetParam());
  world.fixtures = {ShapeOf(PlaneShape{}, kFriction)};
  WorldSpec as_fixture = world;
  as_fixture.models.erase(as_fixture.models.begin());
  as_fixture.fixtures.push_back(ShapeOf(plate, kFriction));
  as_fixture.fixtures.back().pose.position_m = {0, 0, 0.45};
  auto dynamics = MakeDynamics(world);
  auto known = MakeDynamics(as_fixture);
  for (const int ms : {200, 1000, 3000}) {
    const auto states = ReadAllLinks(*dynamics, 3, AtMs(ms));
    const auto expected = ReadAllLinks(*known, 2, AtMs(ms));
    EXPECT_EQ(dynamics->island_count(), 3) << ms;
    EXPECT_EQ(states[0].pose.position_m[2], 0.45);
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(states[i + 1].pose.position_m[axis], expected[i].pose.position_m[axis], 0.01)
            << "model " << i << " at " << ms << " ms";
      }
    }
  }
  const auto end = ReadAllLinks(*dynamics, 3, AtMs(3000));
  EXPECT_NEAR(end[1].pose.position_m[2], 0.6, 1e-3) << "it stands on the table";
  EXPECT_GT(end[2].pose.position_m[0], 1.2) << "it has slid";
}

// What moves on a fixed base does join whom it comes near; the base does not.
TEST_P(ModelsThatMeet, AnArmJoinsWhomItReachesAndItsBaseNobody) {
  RobotModel arm = Pendulum(1, 0.5, 1, 0.02);
  arm.name = "arm";
  arm.at.position_m = {0, 0, 1};
  arm.links[0].shapes.push_back(ShapeOf(BoxShape{{0.4, 0.4, 0.1}}, kFriction));
  arm.links[1].shapes.push_back(ShapeOf(SphereShape{0.05}, kFriction));
  arm.links[1].shapes[0].pose.position_m = {0, 0, -0.5};
  arm.joints[0].initial_position = {1.5};  // beside the base, from where it swings down
  WorldSpec world = WorldOf({arm, Moving("on_top", SphereShape{0.05}, {0.05, 0.05, 1.1}),
                             Moving("below", kBall, {0, 0, 0.42})},
                            GetParam());
  world.fixtures = {ShapeOf(PlaneShape{}, kFriction)};
  world.fixtures[0].pose.position_m = {0, 0, 0.32};
  auto dynamics = MakeDynamics(world);
  (void)ReadAllLinks(*dynamics, 4, AtMs(20));
  EXPECT_EQ(dynamics->island_count(), 3) << "its ball is far from both";
  int least = 3;
  for (int ms = 20; ms <= 800; ms += 10) {
    (void)ReadAllLinks(*dynamics, 4, AtMs(ms));
    least = std::min(least, dynamics->island_count());
  }
  EXPECT_EQ(least, 2) << "it strikes the one below";
  const auto end = ReadAllLinks(*dynamics, 4, AtMs(800));
  EXPECT_NEAR(end[2].pose.position_m[2], 1.1, 2e-3) << "it lies on the base";
  EXPECT_GT(std::abs(end[3].pose.position_m[0]), 0.005) << "it was struck";
}

TEST_P(ModelsThatMeet, SayWhoCannotBeOneSystemTwice) {
  WorldSpec world = Collision(GetParam());
  world.models_together = {{0, 1}, {1}};
  EXPECT_THROW((void)MakeDynamics(world), DynamicsError);
  world.models_together = {{2}};
  EXPECT_THROW((void)MakeDynamics(world), DynamicsError);
}

}  // namespace
}  // namespace tcs
