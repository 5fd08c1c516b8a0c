#include "coordinator/network/dds_paths.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr std::int64_t kMs = 1'000'000;

shm::DdsMessage Message(shm::DdsKind kind, std::int64_t at_ns, std::uint16_t flags = 0) {
  shm::DdsMessage message{};
  message.size = 200;
  message.kind = kind;
  message.flags = flags;
  message.from = 1;
  message.time_ns = at_ns;
  return message;
}

// Processes 1 and 2 are on robot 0, process 3 is on robot 1.
class DdsPathsTest : public testing::Test {
 protected:
  explicit DdsPathsTest(double loss = 0) : wire_(Spec(loss)) {}

  static NetworkSpec Spec(double loss) {
    NetworkSpec spec{.seed = 1, .addresses = {"10.42.0.1", "10.42.0.2"}, .links = {}};
    spec.links.assign(4, {.latency = VirtualDuration::Milliseconds(20), .loss = loss});
    return spec;
  }

  Wire wire_;
  DdsPaths paths_{wire_, [](std::uint32_t process) { return process == 3 ? 1u : 0u; }};
};

class LossyDdsPathsTest : public DdsPathsTest {
 protected:
  LossyDdsPathsTest() : DdsPathsTest(0.2) {}
};

TEST_F(DdsPathsTest, OnOneRobotNothingIsInBetween) {
  EXPECT_EQ(paths_.ArrivalNs(Message(shm::DdsKind::kSample, kMs), 2), kMs);
  EXPECT_EQ(paths_.RoundTripNs(1, 2), 0);
}

TEST_F(DdsPathsTest, BetweenRobotsIsTheLink) {
  EXPECT_EQ(paths_.ArrivalNs(Message(shm::DdsKind::kSample, kMs), 3), 21 * kMs);
  EXPECT_EQ(paths_.RoundTripNs(1, 3), 40 * kMs);
}

TEST_F(LossyDdsPathsTest, BestEffortLosesItsShare) {
  int lost = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto message = Message(shm::DdsKind::kSample, i * kMs, shm::kDdsUnreliable);
    lost += paths_.ArrivalNs(message, 3) == shm::kNeverNs;
  }
  EXPECT_NEAR(lost, 200, 50);
}

TEST_F(LossyDdsPathsTest, WhatIsReliableComesLaterByRoundTripsAndInOrder) {
  std::int64_t last = 0;
  int late = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t sent = i * 10'000 * kMs;
    const std::int64_t arrives = paths_.ArrivalNs(Message(shm::DdsKind::kSample, sent), 3);
    ASSERT_NE(arrives, shm::kNeverNs);
    EXPECT_GE(arrives, last);
    last = arrives;
    if (arrives == sent + 20 * kMs) continue;
    ++late;
    EXPECT_GE(arrives, sent + 60 * kMs);
  }
  EXPECT_NEAR(late, 200, 60);
}

}  // namespace
}  // namespace tcs
