// Rotors whose speed lags and joints that are driven with a lag, of robots that come near each
// other and part: what is left of a command goes over to the island that the robot is in next.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "simbody_bridge/model_group.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

// Longer than the robots are near each other: what was commanded before still fades afterwards.
constexpr VirtualDuration kSlowLag = VirtualDuration::Milliseconds(600);
constexpr double kSlowLagS = 0.6;
constexpr double kHullThrust = 2e-6, kHullKg = 2, kRodKg = 0.1;

class ActuatorsThatMeet : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, ActuatorsThatMeet, testing::ValuesIn(ModelEngines()),
                         NameOfEngine);

// A hull with rods below it that nothing touches, and rotors beside it that turn against each
// other.
RobotModel Craft(const std::string& name, int rods, int rotors, const Geometry& hull,
                 const std::array<double, 3>& at_m,
                 const std::array<double, 3>& velocity_mps = {}) {
  RobotModel model = Pendulum(rods, 0.1, kRodKg, 1e-3);
  model.name = name;
  model.has_fixed_base = false;
  model.links[0].inertial = MassAt(kHullKg, {}, 0.05);
  model.links[0].shapes.push_back({.name = "hull", .geometry = hull, .pose = {}, .friction = 0.5});
  for (Joint& joint : model.joints) joint.drive_lag = kSlowLag;
  for (int i = 0; i < rotors; ++i) {
    Rotor rotor;
    rotor.name = "rotor" + std::to_string(i);
    rotor.link = 0;
    rotor.frame.position_m = {0, i % 2 == 0 ? 0.1 : -0.1, 0};
    rotor.thrust_ns2 = kHullThrust;
    rotor.drag_nms2 = 1e-8;
    rotor.is_clockwise = i % 2 == 0;
    rotor.time_constant = kSlowLag;
    rotor.most_radps = 1000;
    model.rotors.push_back(rotor);
  }
  model.at.position_m = at_m;
  model.linear_velocity_mps = velocity_mps;
  return model;
}

// Three of different makes, so that places of theirs are others in each island. Those at the ends
// of the list fly past each other, 3 cm apart, in the second before 1.5 s; the third is far away.
WorldSpec Passing(IntegratorSpec spec) {
  spec.accuracy = 1e-9;
  const Geometry ball = SphereShape{0.1};
  WorldSpec world =
      WorldOf({Craft("a", 1, 2, ball, {-1, 0, 0}, {1, 0, 0}), Craft("far", 1, 2, ball, {0, 90, 0}),
               Craft("b", 2, 4, ball, {1, 0.23, 0}, {-1, 0, 0})},
              spec);
  world.gravity_mps2 = {};
  return world;
}
constexpr int kHullOfB = 4, kJointOfA = 0, kFirstRotorOfB = 4, kRotorsOfB = 4;

struct Aim {
  std::int64_t at_ns;
  double value;
};
// Before the two meet, while they are near each other, and after they have parted.
constexpr std::array<Aim, 3> kAims = {
    Aim{100'000'000, 300}, {980'000'123, 100}, {1'300'000'000, 200}};

void Command(Dynamics& dynamics, const Aim& aim) {
  for (int i = 0; i < kRotorsOfB; ++i) {
    dynamics.Spin(kFirstRotorOfB + i, aim.value, At(aim.at_ns));
  }
  dynamics.Drive(kJointOfA, {.effort = 1e-5 * aim.value}, At(aim.at_ns));
}

// What follows the aims with the lag, from 0 on; and its square, added up over the time.
struct Followed {
  double value = 0, square_s = 0;
};
Followed Follow(double until_s) {
  Followed followed;
  for (std::size_t i = 0; i < kAims.size(); ++i) {
    const double from_s = 1e-9 * static_cast<double>(kAims[i].at_ns);
    if (from_s >= until_s) break;
    const double to_s = i + 1 < kAims.size()
                            ? std::min(until_s, 1e-9 * static_cast<double>(kAims[i + 1].at_ns))
                            : until_s;
    const double aim = kAims[i].value, missing = followed.value - aim,
                 lags = (to_s - from_s) / kSlowLagS;
    followed.square_s += aim * aim * (to_s - from_s) -
                         2 * aim * missing * kSlowLagS * std::expm1(-lags) -
                         missing * missing * kSlowLagS / 2 * std::expm1(-2 * lags);
    followed.value = aim + missing * std::exp(-lags);
  }
  return followed;
}

TEST_P(ActuatorsThatMeet, GoOnFadingFromIslandToIsland) {
  auto dynamics = MakeDynamics(Passing(GetParam()));
  for (const Aim& aim : kAims) Command(*dynamics, aim);
  int least = 9, last = 0;
  for (int ms = 10; ms <= 2000; ms += 10) {
    const Followed followed = Follow(1e-3 * ms);
    EXPECT_NEAR(ReadJoint(*dynamics, kJointOfA, AtMs(ms)).effort, 1e-5 * followed.value, 1e-12)
        << ms;
    const double impulse = kRotorsOfB * kHullThrust * followed.square_s;
    EXPECT_NEAR(ReadLink(*dynamics, kHullOfB, AtMs(ms)).linear_velocity_mps[2],
                impulse / (kHullKg + 2 * kRodKg), 1e-7)
        << ms;
    last = dynamics->island_count();
    least = std::min(least, last);
    dynamics->AdvanceTo(AtMs(ms));
  }
  EXPECT_EQ(least, 2) << "they met";
  EXPECT_EQ(last, 3) << "they parted";
}

struct Everything {
  std::array<LinkState, 7> links;
  std::array<JointState, 4> joints;
};
Everything ReadAll(Dynamics& dynamics, std::int64_t ns) {
  Everything all;
  dynamics.ReadLinks(At(ns), std::array{0, 1, 2, 3, 4, 5, 6}, all.links);
  dynamics.ReadJoints(At(ns), std::array{0, 1, 2, 3}, all.joints);
  return all;
}
bool SameBits(const Everything& a, const Everything& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// Each command comes when the meeting and the parting have been computed already.
TEST_P(ActuatorsThatMeet, AreTakenBackThroughAMeeting) {
  constexpr std::int64_t kEndNs = 1'700'000'000;
  auto known = MakeDynamics(Passing(GetParam()));
  auto leading = MakeDynamics(Passing(GetParam()));
  for (const Aim& aim : kAims) Command(*known, aim);
  std::unique_ptr<Dynamics::Checkpoint> in_meeting;
  for (const Aim& aim : kAims) {
    leading->AdvanceTo(At(aim.at_ns));
    (void)ReadAll(*leading, kEndNs);
    if (&aim == &kAims[1]) in_meeting = leading->Save();
    Command(*leading, aim);
    EXPECT_TRUE(SameBits(ReadAll(*known, aim.at_ns), ReadAll(*leading, aim.at_ns))) << aim.at_ns;
  }
  const Everything end = ReadAll(*known, kEndNs);
  EXPECT_TRUE(SameBits(end, ReadAll(*leading, kEndNs)));
  EXPECT_GE(leading->work().taken_back, 4);
  EXPECT_GT(leading->work().regrouped, known->work().regrouped);
  leading->Restore(*in_meeting);
  (void)ReadAll(*leading, kEndNs);
  for (std::size_t i = 1; i < kAims.size(); ++i) Command(*leading, kAims[i]);
  EXPECT_TRUE(SameBits(end, ReadAll(*leading, kEndNs)));
}

// Islands that ended where two met go on when an earlier command takes that back: and heed what was
// commanded since.
TEST_P(ActuatorsThatMeet, HeedCommandsThatComeInTheReverseOrder) {
  constexpr std::int64_t kEndNs = 1'700'000'000;
  auto known = MakeDynamics(Passing(GetParam()));
  auto leading = MakeDynamics(Passing(GetParam()));
  for (const Aim& aim : kAims) Command(*known, aim);
  const Everything end = ReadAll(*known, kEndNs);
  std::unique_ptr<Dynamics::Checkpoint> before_first;
  for (std::size_t i = kAims.size(); i-- > 0;) {
    (void)ReadAll(*leading, kEndNs);
    if (i == 0) before_first = leading->Save();
    Command(*leading, kAims[i]);
  }
  EXPECT_TRUE(SameBits(end, ReadAll(*leading, kEndNs)));
  leading->Restore(*before_first);
  Command(*leading, kAims[0]);
  EXPECT_TRUE(SameBits(end, ReadAll(*leading, kEndNs)));
}

// The three on a floor, pushed towards each other and away: read ahead of the commands, which come
// in any order within a few, taken back, saved and restored.
TEST_P(ActuatorsThatMeet, AreTakenBackToTheByte) {
  constexpr std::size_t kAtOnce = 4;
  const Geometry box = BoxShape{{0.2, 0.3, 0.2}};
  WorldSpec world =
      WorldOf({Craft("a", 1, 2, box, {0, 0, 0.1}), Craft("b", 1, 2, box, {0.8, 0.1, 0.1}),
               Craft("c", 2, 4, box, {1.6, 0.2, 0.1})},
              GetParam());
  world.fixtures.push_back({.name = "floor", .geometry = PlaneShape{}, .pose = {}});
  auto known = MakeDynamics(world);
  auto leading = MakeDynamics(world);
  std::mt19937_64 random(11);
  const auto draw = [&](std::uint64_t below) {
    return static_cast<std::int64_t>(random() % below);
  };
  struct Timed {
    std::int64_t at_ns;
    int kind, index;
    double value;
  };
  std::vector<Timed> commands;
  std::int64_t at_ns = 0;
  for (std::size_t i = 0; i < 66 * kAtOnce; ++i) {
    if (draw(4) != 0) at_ns += 1 + draw(15'000'000);
    const int kind = static_cast<int>(draw(4));
    const std::array<std::uint64_t, 4> parts = {8, 4, 3, 3};
    const int index = static_cast<int>(draw(parts[static_cast<std::size_t>(kind)]));
    commands.push_back({at_ns, kind, index, static_cast<double>(draw(1000))});
  }
  const auto apply = [](Dynamics& dynamics, const Timed& of) {
    const VirtualTime at = At(of.at_ns);
    if (of.kind == 0) return dynamics.Spin(of.index, of.value, at);
    if (of.kind == 1) {
      return dynamics.Drive(
          of.index, {.effort = 0.1, .stiffness = 1, .position = 1e-3 * of.value, .damping = 0.1},
          at);
    }
    // Towards the one in the middle more often than away from it.
    const double push = (of.index == 2 ? -1.0 : 1.0) * (0.05 * of.value - 17);
    dynamics.ApplyToLink(2 * of.index, WrenchFrame::kWorld, {.force_n = {push, 0.1 * push, 0}}, at);
  };
  for (const Timed& command : commands) apply(*known, command);
  std::unique_ptr<Dynamics::Checkpoint> checkpoint;
  std::vector<bool> is_given(commands.size(), false);
  int most = 0, least = 9;
  for (std::size_t first = 0; first < commands.size(); first += kAtOnce) {
    const std::int64_t now_ns = commands[first].at_ns;
    known->AdvanceTo(At(now_ns));
    leading->AdvanceTo(At(now_ns));
    ASSERT_TRUE(SameBits(ReadAll(*known, now_ns), ReadAll(*leading, now_ns)))
        << "before command " << first << " at " << now_ns;
    most = std::max(most, known->island_count());
    least = std::min(least, known->island_count());
    // Those for one instant stay in their order.
    std::vector<std::size_t> some(kAtOnce);
    std::iota(some.begin(), some.end(), first);
    const std::int64_t turned = draw(1'000'003);
    std::stable_sort(some.begin(), some.end(), [&](std::size_t a, std::size_t b) {
      return commands[a].at_ns * turned % 1'000'003 < commands[b].at_ns * turned % 1'000'003;
    });
    for (const std::size_t i : some) {
      (void)ReadLink(*leading, static_cast<int>(draw(7)), At(now_ns + draw(100'000'000)));
      if (draw(8) == 0) checkpoint = leading->Save(std::move(checkpoint));
      apply(*leading, commands[i]);
      is_given[i] = true;
      if (checkpoint == nullptr || draw(8) != 0) continue;
      leading->Restore(*checkpoint);
      for (std::size_t k = 0; k < commands.size(); ++k) {
        if (is_given[k] && At(commands[k].at_ns) >= leading->Now()) apply(*leading, commands[k]);
      }
    }
  }
  EXPECT_EQ(most, 3);
  EXPECT_LE(least, 2) << "they met";
  EXPECT_GT(known->work().regrouped, 10);
  EXPECT_GT(leading->work().regrouped, known->work().regrouped) << "meetings were taken back";
  EXPECT_GT(leading->work().taken_back, 100);
}

TEST(ModelGroups, CountEachPlaceOnce) {
  const std::vector<RobotModel> all = Passing({}).models;
  const std::array<ModelGroup, 3> alone = {ModelGroup(all, {0}, 0), ModelGroup(all, {1}, 1),
                                           ModelGroup(all, {2}, 2)};
  const ModelGroup group(all, {0, 1, 2}, 3);
  std::vector<bool> seen(static_cast<std::size_t>(group.places()), false);
  for (std::size_t member = 0; member < alone.size(); ++member) {
    for (int place = 0; place < alone[member].places(); ++place) {
      const int in_group = group.PlaceIn(member, place);
      ASSERT_FALSE(seen.at(static_cast<std::size_t>(in_group))) << member << ' ' << place;
      seen[static_cast<std::size_t>(in_group)] = true;
      EXPECT_EQ(group.Locate(in_group), std::pair(member, place));
    }
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](bool is_seen) { return is_seen; }));
}

}  // namespace
}  // namespace tcs
