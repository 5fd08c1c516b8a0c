// Islands that are integrated on several processors.
#include "simbody_bridge/team.h"

#include <sched.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <thread>

#include "tests/unit/dynamics/random_commands.h"
#include "tests/unit/dynamics/test_models.h"

namespace tcs {
namespace {

// The last one that this process may use.
int SomeCpu() {
  cpu_set_t all;
  sched_getaffinity(0, sizeof all, &all);
  int cpu = CPU_SETSIZE - 1;
  while (!CPU_ISSET(cpu, &all)) --cpu;
  return cpu;
}

// One that has been joined may be there for a moment more.
std::ptrdiff_t ThreadsOfThis() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
}

// Until `holds`, and no longer than machines are that busy.
template <class Holds>
bool ComesTrue(const Holds& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
  }
  return true;
}

TEST(Team, DoesEachPieceOnceWhoeverDoesIt) {
  std::int64_t helped = 0;
  Team team(helped);
  const std::array cpus = {SomeCpu(), SomeCpu()};
  team.Set(cpus);
  team.AlwaysAsk();
  EXPECT_EQ(team.workers(), 3u);
  PieceCost cost;
  std::array<std::atomic<std::int64_t>, 3> by_worker{};
  std::int64_t all = 0;
  EXPECT_TRUE(ComesTrue([&] {
    std::array<int, 50> times{};
    team.ForEach(times.size(), &cost, [&](std::size_t piece, std::size_t worker) {
      ++times[piece];
      ++by_worker[worker];
      std::this_thread::sleep_for(std::chrono::microseconds(20));
    });
    for (const int of : times) EXPECT_EQ(of, 1);
    all += 50;
    return by_worker[1] > 0 && by_worker[2] > 0;
  }));
  EXPECT_EQ(by_worker[0] + by_worker[1] + by_worker[2], all);
  EXPECT_EQ(helped, by_worker[1] + by_worker[2]);
}

TEST(Team, AsksNobodyForWhatIsNotWorthAWake) {
  std::int64_t helped = 0;
  Team team(helped);
  team.Set(std::array{SomeCpu()});
  PieceCost cost;
  int cheap = 0;
  for (int i = 0; i < 1000; ++i) {
    // Not so for a while where the host has kept this thread waiting in the midst of a piece.
    const bool is_cheap = cost.ns() < 20'000;
    if (is_cheap) ++cheap;
    team.ForEach(10, &cost, [is_cheap](std::size_t, std::size_t worker) {
      EXPECT_TRUE(worker == 0 || !is_cheap);
    });
  }
  EXPECT_GT(cheap, 500);
}

TEST(Team, LeavesNoThreadBehindAndNoneAtRealTimePriority) {
  const std::ptrdiff_t before = ThreadsOfThis();
  std::int64_t helped = 0;
  {
    Team team(helped);
    team.Set(std::array{SomeCpu()});
    EXPECT_EQ(ThreadsOfThis(), before + 1);
    team.AlwaysAsk();
    PieceCost cost;
    std::atomic<int> policy{-1};
    EXPECT_TRUE(ComesTrue([&] {
      team.ForEach(2, &cost, [&](std::size_t, std::size_t worker) {
        if (worker == 1) policy = sched_getscheduler(0);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      });
      return policy >= 0;
    }));
    EXPECT_EQ(policy, SCHED_OTHER);
    team.Set({});
    EXPECT_TRUE(ComesTrue([&] { return ThreadsOfThis() == before; }));
    team.ForEach(2, &cost, [](std::size_t, std::size_t worker) { EXPECT_EQ(worker, 0u); });
  }
  EXPECT_TRUE(ComesTrue([&] { return ThreadsOfThis() == before; }));
}

class OnTwoProcessors : public EveryEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, OnTwoProcessors, testing::ValuesIn(Engines()), NameOfEngine);

// Until helpers have done a part of it, where the engine lets them.
TEST_P(OnTwoProcessors, BodiesMoveTheSameToTheBit) {
  WorldSpec world = BusyWorldInTheWind(GetParam());
  while (world.bodies.size() < 150) {
    world.bodies.push_back(world.bodies[0]);
    world.bodies.back().initial.position_m[1] = 0.01 * static_cast<double>(world.bodies.size());
  }
  for (BodySpec& body : world.bodies) body.drag = world.bodies[1].drag;
  auto one = MakeDynamics(world);
  auto two = MakeDynamics(world);
  two->UseProcessors(std::array{SomeCpu()});
  std::mt19937_64 random(5);
  // Many, for a helper may have to wait for its processor while another run has it.
  const auto commands = RandomCommands(40'000, 150, 2'000'000, random, Kinds::kAll);
  const bool may_help = GetParam().engine != EngineKind::kOde;
  std::size_t next = 0;
  const auto go_on = [&] {
    const std::int64_t until_ns = commands[next].at_ns + 10'000'000;
    for (; next < commands.size() && commands[next].at_ns < until_ns; ++next) {
      one->Apply(commands[next].body, commands[next].wrench, At(commands[next].at_ns));
      two->Apply(commands[next].body, commands[next].wrench, At(commands[next].at_ns));
    }
    EXPECT_TRUE(SameBits(StatesAt(*one, until_ns, 150), StatesAt(*two, until_ns, 150)));
    one->AdvanceTo(At(until_ns));
    two->AdvanceTo(At(until_ns));
    while (next < commands.size() && commands[next].at_ns < until_ns) ++next;
    return next + 100 > commands.size();
  };
  int rounds = 0;
  while (!go_on() && (rounds < 20 || (may_help && two->work().helped == 0))) ++rounds;
  EXPECT_EQ(one->work().steps, two->work().steps);
  EXPECT_EQ(one->work().helped, 0);
  EXPECT_EQ(two->work().helped > 0, may_help);
}

class ModelsOnTwoProcessors : public EveryModelEngine {};

INSTANTIATE_TEST_SUITE_P(Engines, ModelsOnTwoProcessors, testing::ValuesIn(ModelEngines()),
                         NameOfEngine);

// Boxes that slide on a floor, meet and part, until helpers have taken part.
TEST_P(ModelsOnTwoProcessors, ModelsMoveTheSameToTheBit) {
  WorldSpec world = WorldOf({}, GetParam());
  world.fixtures = {{.name = "", .geometry = PlaneShape{}, .pose = {}, .friction = 0.2}};
  constexpr int kModels = 12;
  for (int i = 0; i < kModels; ++i) {
    RobotModel model;
    model.name = "box" + std::to_string(i);
    model.links.push_back(LinkOf(model.name, MassAt(1, {}, 0.01)));
    model.links[0].shapes.push_back(
        {.name = "", .geometry = BoxShape{{0.2, 0.2, 0.2}}, .pose = {}, .friction = 0.2});
    model.at.position_m = {0.6 * (i % 4), 0.6 * (i / 4), 0.1};
    world.models.push_back(model);
  }
  std::vector<int> links(kModels);
  std::iota(links.begin(), links.end(), 0);
  const auto run = [&](std::span<const int> cpus) {
    auto dynamics = MakeDynamics(world);
    dynamics->UseProcessors(cpus);
    std::mt19937_64 random(9);
    std::vector<LinkState> states(kModels);
    for (int ms = 0; ms <= 600; ms += 15) {
      dynamics->AdvanceTo(AtMs(ms));
      dynamics->ReadLinks(AtMs(ms), links, states);
      for (int k = 0; k < 3; ++k) {
        const auto draw = [&] { return static_cast<double>(random() % 17) - 8; };
        dynamics->ApplyToLink(static_cast<int>(random() % kModels), WrenchFrame::kWorld,
                              {.force_n = {draw(), draw(), 0}}, AtMs(ms));
      }
    }
    return std::pair(states, dynamics->work());
  };
  const auto one = run({});
  EXPECT_GT(one.second.regrouped, 5);
  EXPECT_TRUE(ComesTrue([&] {
    const auto two = run(std::array{SomeCpu()});
    EXPECT_EQ(std::memcmp(one.first.data(), two.first.data(), kModels * sizeof(LinkState)), 0);
    EXPECT_EQ(one.second.steps, two.second.steps);
    EXPECT_EQ(one.second.regrouped, two.second.regrouped);
    return two.second.helped > 0;
  })) << "no helper ever took part";
}

}  // namespace
}  // namespace tcs
