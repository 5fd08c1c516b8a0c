#include "coordinator/tasks/program_clock.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace tcs {
namespace {

constexpr VirtualDuration Ms(std::int64_t ms) { return VirtualDuration::Milliseconds(ms); }
constexpr VirtualTime RobotMs(std::int64_t ms) { return RobotTime(Ms(ms).ns()); }
constexpr ProgramTime OwnMs(std::int64_t ms) { return OwnTime(Ms(ms).ns()); }

static_assert(!std::is_convertible_v<ProgramTime, VirtualTime>);
static_assert(!std::is_convertible_v<VirtualTime, ProgramTime>);

TEST(ProgramClock, IsItsRobotsAtFirst) {
  const ProgramClock clock;
  EXPECT_EQ(clock.lead(), VirtualDuration());
  EXPECT_EQ(clock.At(RobotMs(5)), OwnMs(5));
  EXPECT_EQ(clock.RobotTimeOf(OwnMs(5)), RobotMs(5));
}

TEST(ProgramClock, GoesOnWhileTheWorldStands) {
  ProgramClock clock;
  clock.Advance(RobotMs(10), Ms(3));
  EXPECT_EQ(clock.At(RobotMs(10)), OwnMs(13));
  clock.Advance(RobotMs(10), Ms(1));
  EXPECT_EQ(clock.lead(), Ms(4));
  EXPECT_EQ(clock.shown(), OwnMs(14));
  EXPECT_EQ(clock.RobotTimeOf(OwnMs(20)), RobotMs(16));
}

TEST(ProgramClock, StandsUntilTheWorldHasCaughtUp) {
  ProgramClock clock;
  clock.Advance(RobotMs(10), Ms(3));
  clock.LetWorldCatchUp(RobotMs(12));
  EXPECT_EQ(clock.lead(), Ms(1));
  EXPECT_EQ(clock.At(RobotMs(12)), OwnMs(13));
  clock.LetWorldCatchUp(RobotMs(20));
  EXPECT_EQ(clock.lead(), VirtualDuration());
  EXPECT_EQ(clock.shown(), OwnMs(13));
}

TEST(ProgramClock, IsNotBehindTheEndOfAWaitThatIsOver) {
  ProgramClock clock;
  clock.Advance(RobotMs(10), Ms(3));
  clock.ComeTo(OwnMs(18));
  clock.ComeTo(OwnMs(15));
  EXPECT_EQ(clock.shown(), OwnMs(18));
  clock.LetWorldCatchUp(RobotMs(11));
  EXPECT_EQ(clock.At(RobotMs(11)), OwnMs(18));
}

// A thread that waits keeps the lead that its process's clock had, whatever others of it compute.
TEST(ProgramClock, TellsWhatAWaitingThreadsDeadlineIsToIt) {
  EXPECT_EQ(ProgramClock::At(RobotMs(10), Ms(3)), OwnMs(13));
}

TEST(ProgramClock, NeverStaysNever) {
  ProgramClock clock;
  clock.Advance(RobotMs(10), Ms(3));
  EXPECT_TRUE(clock.At(VirtualTime::Never()).IsNever());
  EXPECT_TRUE(clock.RobotTimeOf(ProgramTime::Never()).IsNever());
}

TEST(ProgramClock, KnowsForHowLongTheWorldWasHeldUpAtOneTime) {
  ProgramClock clock;
  clock.NoteHeld(RobotMs(10), Ms(3));
  clock.NoteHeld(RobotMs(10), Ms(4));
  EXPECT_EQ(clock.HeldAt(RobotMs(10)), Ms(7));
  EXPECT_EQ(clock.HeldAt(RobotMs(11)), VirtualDuration());
  clock.NoteHeld(RobotMs(11), Ms(1));
  EXPECT_EQ(clock.HeldAt(RobotMs(10)), VirtualDuration());
  EXPECT_EQ(clock.HeldAt(RobotMs(11)), Ms(1));
}

TEST(ProgramClock, OfAChildShowsTheSameAndHasHeldNobodyUp) {
  ProgramClock parent;
  parent.NoteHeld(RobotMs(10), Ms(3));
  parent.Advance(RobotMs(10), Ms(3));
  const ProgramClock child = parent.Fork();
  EXPECT_EQ(child.lead(), Ms(3));
  EXPECT_EQ(child.shown(), OwnMs(13));
  EXPECT_EQ(child.HeldAt(RobotMs(10)), VirtualDuration());
}

}  // namespace
}  // namespace tcs
