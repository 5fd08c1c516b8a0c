#include "coordinator/host/own_work.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr HostDuration kMicrosecond = HostDuration::Microseconds(1);
constexpr HostDuration kMillisecond = HostDuration::Milliseconds(1);

HostDuration NotInKernel() { return {}; }

// One turn of so long, of which the shim says all that it may, of a process that has been in the
// kernel for so long.
HostDuration SaysAllItMay(OwnWork* work, HostDuration turn, HostDuration in_kernel) {
  work->TurnBegins();
  work->Allow(turn, [&] { return in_kernel; });
  const HostDuration said = work->most();
  work->Believe(said);
  return said;
}

TEST(OwnWork, IsAShareOfATurn) {
  OwnWork work;
  work.TurnBegins();
  EXPECT_EQ(work.most(), HostDuration());
  work.Allow(kMicrosecond * 400, NotInKernel);
  EXPECT_EQ(work.most(), kMicrosecond * 300);
}

// The coordinator may look several times in a turn.
TEST(OwnWork, IsNotSaidTwiceInATurn) {
  OwnWork work;
  work.TurnBegins();
  work.Allow(kMicrosecond * 400, NotInKernel);
  work.Believe(kMicrosecond * 300);
  EXPECT_EQ(work.most(), HostDuration());
  work.Allow(kMicrosecond * 800, NotInKernel);
  EXPECT_EQ(work.most(), kMicrosecond * 300);
  work.TurnBegins();
  work.Allow(kMicrosecond * 4, NotInKernel);
  EXPECT_EQ(work.most(), kMicrosecond * 3);
}

TEST(OwnWork, ATurnThatHasNotBegunYetHasNone) {
  OwnWork work;
  work.TurnBegins();
  work.Allow(-kMillisecond, NotInKernel);
  EXPECT_EQ(work.most(), HostDuration());
}

// A program that computes, and says that its shim did.
TEST(OwnWork, IsNotBelievedForLongWhereTheProcessIsNotInTheKernel) {
  for (const HostDuration turn : {kMicrosecond * 10, kMillisecond, kMillisecond * 100}) {
    OwnWork work;
    HostDuration believed, ran;
    for (; ran < kMillisecond * 1'000; ran += turn) {
      believed += SaysAllItMay(&work, turn, HostDuration());
    }
    EXPECT_EQ(believed, OwnWork::kUnproven);
  }
}

TEST(OwnWork, IsBelievedAsFarAsTheKernelsBooksBearItOut) {
  OwnWork work;
  HostDuration believed, ran;
  for (int turn = 0; turn < 1'000; ++turn, ran += kMillisecond) {
    believed += SaysAllItMay(&work, kMillisecond, ran);
  }
  EXPECT_EQ(believed, kMillisecond * 750);
}

// The books count in ticks: what they do not tell yet they tell later.
TEST(OwnWork, IsBelievedAgainWhenTheBooksSaySo) {
  OwnWork work;
  for (int turn = 0; turn < 20; ++turn) SaysAllItMay(&work, kMillisecond, HostDuration());
  EXPECT_EQ(SaysAllItMay(&work, kMillisecond, HostDuration()), HostDuration());
  for (int turn = 0; turn < 5; ++turn) SaysAllItMay(&work, kMillisecond, kMillisecond * 10);
  EXPECT_EQ(SaysAllItMay(&work, kMillisecond * 4, kMillisecond * 10), kMillisecond * 3);
}

}  // namespace
}  // namespace tcs
