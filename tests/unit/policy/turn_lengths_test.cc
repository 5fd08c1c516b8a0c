#include "coordinator/policy/turn_lengths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>

#include "tests/unit/policy/simulated_robot.h"

namespace tcs {
namespace {

constexpr VirtualDuration kQuantum = VirtualDuration::Milliseconds(1);

TEST(TurnLengths, AreTheSameWithoutASeed) {
  const TurnLengths lengths(std::nullopt);
  EXPECT_EQ(lengths.OfTurn(kOne, RobotTime(5), kQuantum), kQuantum);
  EXPECT_EQ(lengths.OfStep(1, RobotTime(5), kQuantum), kQuantum);
  EXPECT_EQ(lengths.SlackOf(kOne, RobotTime(5)), VirtualDuration());
}

TEST(TurnLengths, AreOneOnAverage) {
  const TurnLengths lengths(7);
  std::int64_t least = INT64_MAX, most = 0, sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t ns = lengths.OfTurn(kOne, RobotTime(i * kMilli), kQuantum).ns();
    least = std::min(least, ns);
    most = std::max(most, ns);
    sum += ns;
  }
  EXPECT_GE(least, kMilli / 2);
  EXPECT_LT(least, kMilli / 2 + 10 * kMicro);
  EXPECT_LT(most, 3 * kMilli / 2);
  EXPECT_GT(most, 3 * kMilli / 2 - 10 * kMicro);
  EXPECT_NEAR(static_cast<double>(sum) / 1000, kMilli, 30 * kMicro);
}

TEST(TurnLengths, LongTurnsVaryByAsMuch) {
  const TurnLengths lengths(7);
  for (int i = 0; i < 100; ++i) {
    const std::int64_t ns = lengths.OfTurn(kOne, RobotTime(i), 100 * kQuantum).ns();
    EXPECT_GE(ns, 100 * kMilli - kMilli / 2);
    EXPECT_LT(ns, 100 * kMilli + kMilli / 2);
  }
}

TEST(TurnLengths, StepsAreHalfToAllOfWhatTheyMayBe) {
  const TurnLengths lengths(7);
  for (int i = 0; i < 100; ++i) {
    const std::int64_t ns = lengths.OfStep(1, RobotTime(i), kQuantum).ns();
    EXPECT_GE(ns, kMilli / 2);
    EXPECT_LE(ns, kMilli);
  }
  for (const std::int64_t ns : {std::int64_t{1}, 100 * kMicro}) {
    EXPECT_EQ(lengths.OfStep(1, RobotTime(5), VirtualNs(ns)), VirtualNs(ns));
  }
}

TEST(TurnLengths, DependOnSeedThreadAndTimeAlone) {
  std::set<std::int64_t> seen;
  for (const std::uint64_t seed : {1, 2}) {
    for (const int thread : {kOne, kTwo}) {
      for (const std::int64_t at : {std::int64_t{0}, kMilli}) {
        const auto draw = [&] {
          return TurnLengths(seed).OfTurn(thread, RobotTime(at), kQuantum).ns();
        };
        EXPECT_EQ(draw(), draw());
        EXPECT_TRUE(seen.insert(draw()).second);
      }
    }
  }
}

// Of two that compute, on one core, from that seed.
TEST(TurnLengths, EndTurnsAtOtherPlacesOfALoopEachTime) {
  constexpr std::int64_t kLoop = 8 * kMicro;
  SimulatedRobot robot(1, true, 3);
  robot.AddReady(kOne);
  robot.AddReady(kTwo);
  std::set<std::int64_t> places;
  for (int turn = 0; turn < 100; ++turn) {
    const std::int64_t ns = robot.Horizon() - robot.Progress();
    places.insert(ns % kLoop / kMicro);
    const int thread = robot.Next();
    robot.Run(ns);
    EXPECT_NE(robot.Next(), thread);
  }
  EXPECT_EQ(places.size(), 8u);
}

// One computes, an equal one sleeps and goes first when it wakes.
TEST(TurnLengths, AWakingEqualTakesTheCoreAFewMicrosecondsLater) {
  SimulatedRobot robot(1, true, 3);
  robot.AddReady(kTwo);
  robot.Add(kOne);
  robot.Run(kMilli / 4);
  std::set<std::int64_t> seen;
  for (int i = 1; i <= 20; ++i) {
    const std::int64_t due = robot.Progress() + i * kMicro;
    robot.Sleep(kOne, {.until = RobotTime(due)});
    EXPECT_GE(robot.Horizon(), due);
    EXPECT_LT(robot.Horizon(), due + TurnLengths::kSlack.ns());
    seen.insert(robot.Horizon() - due);
  }
  EXPECT_GT(seen.size(), 15u);
}

}  // namespace
}  // namespace tcs
