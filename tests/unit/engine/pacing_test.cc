#include "coordinator/engine/pacing.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/unit/times.h"

namespace tcs {
namespace {

// A paused run lends its processor, and may have to wait for it afterwards.
TEST(Pacing, WhoWaitsForItsProcessorDoesNotStandStill) {
  Pacing pacing({}, AtMs(1'000), {});
  EXPECT_EQ(pacing.ToWait(AtMs(1)), HostDuration());
  usleep(1'000);
  EXPECT_EQ(pacing.ToWait(AtMs(1)), HostDuration());
  EXPECT_EQ(pacing.held(), HostDuration());
  pacing.WaitForProcessor();
  usleep(20'000);
  EXPECT_EQ(pacing.ToWait(AtMs(1)), HostDuration());
  const HostDuration held = pacing.held();
  EXPECT_GE(held, HostDuration::Milliseconds(20));
  usleep(1'000);
  EXPECT_EQ(pacing.ToWait(AtMs(1)), HostDuration());
  EXPECT_EQ(pacing.held(), held);
}

}  // namespace
}  // namespace tcs
