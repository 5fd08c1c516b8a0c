// Runs of many commands, for the tests of what a motion depends on.
#pragma once

#include <stdlib.h>

#include <numeric>
#include <random>
#include <vector>

#include "tests/unit/dynamics/test_worlds.h"

namespace tcs {

struct TimedCommand {
  std::int64_t at_ns;
  int body;
  Wrench wrench;
};

enum class Kinds {
  kPlain,  // in the world's frame and at once
  kAll,    // or in the body's, or with a lag
};

// In the order of their times. Some change nothing, some come together, and many fall between the
// steps.
inline std::vector<TimedCommand> RandomCommands(int count, int bodies, std::int64_t longest_gap_ns,
                                                std::mt19937_64& random,
                                                Kinds kinds = Kinds::kPlain) {
  std::vector<TimedCommand> commands;
  std::vector<Wrench> last(static_cast<std::size_t>(bodies));
  std::int64_t at_ns = 0;
  for (int i = 0; i < count; ++i) {
    const auto draw = [&](int below) { return static_cast<int>(random() % below); };
    if (draw(5) != 0) at_ns += 1 + static_cast<std::int64_t>(random() % longest_gap_ns);
    const int body = draw(bodies);
    Wrench& wrench = last[static_cast<std::size_t>(body)];
    if (draw(4) != 0) {
      wrench = {.force_n = {0.5 * draw(7) - 1.5, 0.25 * draw(5) - 0.5, 15.0 + draw(2)},
                .torque_nm = {0.01 * draw(3) - 0.01, 0, 0.02 * draw(3) - 0.02}};
      if (kinds == Kinds::kAll) {
        wrench.in_body_frame = draw(2) == 0;
        if (draw(2) == 0) wrench.lag = VirtualDuration::Microseconds(1 + draw(20'000));
      }
    }
    commands.push_back({at_ns, body, wrench});
  }
  return commands;
}

inline void ApplyAll(const std::vector<TimedCommand>& commands, Dynamics& dynamics) {
  for (const TimedCommand& command : commands) {
    dynamics.Apply(command.body, command.wrench, At(command.at_ns));
  }
}

inline std::vector<BodyState> StatesAt(Dynamics& dynamics, std::int64_t ns, int bodies) {
  std::vector<int> all(static_cast<std::size_t>(bodies));
  std::iota(all.begin(), all.end(), 0);
  std::vector<BodyState> states(all.size());
  dynamics.Read(At(ns), all, states);
  return states;
}

// How many commands a long course has: ten thousand with `./dev test --all`.
inline int ManyCommands() {
  const char* const given = getenv("TCS_TEST_COMMANDS");
  return given != nullptr ? atoi(given) : 1'500;
}

// Read ahead of the commands by up to 40 ms, so that most of them take something back.
inline void ExpectTakenBackToTheByte(const WorldSpec& world, int count,
                                     Kinds kinds = Kinds::kPlain) {
  std::mt19937_64 random(11);
  const int bodies = static_cast<int>(world.bodies.size());
  const auto commands = RandomCommands(count, bodies, 8'000'000, random, kinds);
  auto known = MakeDynamics(world);
  auto leading = MakeDynamics(world);
  ApplyAll(commands, *known);
  std::unique_ptr<Dynamics::Checkpoint> checkpoint;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::int64_t now_ns = commands[i].at_ns;
    known->AdvanceTo(At(now_ns));
    leading->AdvanceTo(At(now_ns));
    ASSERT_TRUE(SameBits(StatesAt(*known, now_ns, bodies), StatesAt(*leading, now_ns, bodies)))
        << "before command " << i << " at " << now_ns << " ns";
    (void)StatesAt(*leading, now_ns + static_cast<std::int64_t>(random() % 40'000'000), bodies);
    if (random() % 8 == 0) checkpoint = leading->Save(std::move(checkpoint));
    leading->Apply(commands[i].body, commands[i].wrench, At(now_ns));
    if (checkpoint != nullptr && random() % 8 == 0) {
      // The commands since then once more, in a branch that comes to the same.
      leading->Restore(*checkpoint);
      const VirtualTime from = leading->Now();
      std::size_t first = i + 1;
      while (first > 0 && At(commands[first - 1].at_ns) >= from) --first;
      for (std::size_t k = first; k <= i; ++k) {
        leading->Apply(commands[k].body, commands[k].wrench, At(commands[k].at_ns));
      }
    }
  }
  EXPECT_GT(leading->work().taken_back, count / 3);
  EXPECT_EQ(known->work().taken_back, 0);
}

}  // namespace tcs
