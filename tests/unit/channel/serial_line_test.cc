#include "coordinator/channel/pty/serial_line.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr VirtualTime Ns(std::int64_t ns) { return VirtualTime::FromNanoseconds(ns); }

TEST(SerialLine, AByteTakesTheTimeOfItsBits) {
  SerialLine line(10, 115'200);
  EXPECT_EQ(line.Send(Ns(1000)), Ns(1000 + 86'806));  // 86805.56
  EXPECT_EQ(line.free_at(), Ns(87'806));
}

TEST(SerialLine, WhatIsRoundedDoesNotAddUp) {
  SerialLine line(10, 115'200);
  for (int i = 1; i < 115'200 * 36; ++i) line.Send(Ns(0));
  EXPECT_EQ(line.Send(Ns(0)), Ns(360'000'000'000));  // six minutes to the nanosecond
}

TEST(SerialLine, AByteWaitsForTheOnesBefore) {
  SerialLine line(8, 8'000'000);  // 1 us
  EXPECT_EQ(line.Send(Ns(0)), Ns(1000));
  EXPECT_EQ(line.Send(Ns(10)), Ns(2000));
  EXPECT_EQ(line.Send(Ns(5000)), Ns(6000));
}

TEST(SerialLine, LongRunsDoNotOverflow) {
  const SerialLine line(12, 100'000'000);
  EXPECT_EQ(line.TimeOf(100'000'000'000), VirtualDuration::Seconds(12'000));
}

}  // namespace
}  // namespace tcs
