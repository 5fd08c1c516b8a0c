#include "coordinator/calls/dds_costs.h"

#include <gtest/gtest.h>

#include "coordinator/scenario/scenario.h"

namespace tcs {
namespace {

constexpr std::int64_t kUs = 1000;

PriceBySize Us(std::int64_t us) {
  const VirtualDuration time = VirtualDuration::Microseconds(us);
  return PriceBySize({time, time, time, time});
}

shm::DdsMessage Sample(std::int64_t stamp_ns, std::uint16_t flags = 0) {
  shm::DdsMessage message{};
  message.size = 200;
  message.payload_size = 40;
  message.kind = shm::DdsKind::kSample;
  message.flags = flags;
  message.from = 1;
  message.time_ns = 5'000'000;
  message.source_timestamp_ns = stamp_ns;
  return message;
}

// Process 1 writes; all others read.
class DdsCostsTest : public testing::Test {
 protected:
  DdsCostsTest() {
    robot_.prices = {.name = "",
                     .dds_reliable = {Us(10), Us(3), Us(20)},
                     .dds_best_effort = {Us(11), Us(4), Us(21)},
                     .dds_computed = {Us(100), Us(200), Us(400)}};
    process_.robot = &robot_;
    process_.call_cost = ClientSpec{}.fixed_call_cost;
  }

  const Process* Of(std::uint32_t number) const { return number == 0 ? nullptr : &process_; }

  Robot robot_{"robot", 1.0, RobotScheduler(1, true, [](int) { return RobotScheduler::Wait{}; })};
  Process process_;
  DdsCosts costs_{false, [this](std::uint32_t number) { return Of(number); }};
  DdsCosts by_calls_{true, [this](std::uint32_t number) { return Of(number); }};
};

TEST_F(DdsCostsTest, ASampleLeavesWhenItsWriterHasDoneItsPart) {
  EXPECT_EQ(costs_.ArrivalNs(Sample(1), 2), 5'000'000 + 10 * kUs);
  EXPECT_EQ(costs_.TakeForSent(), VirtualDuration::Microseconds(10));
  EXPECT_EQ(costs_.TakeForSent(), VirtualDuration());
}

TEST_F(DdsCostsTest, OneSampleForFurtherProcessesCostsLess) {
  costs_.ArrivalNs(Sample(1), 2);
  EXPECT_EQ(costs_.ArrivalNs(Sample(1), 3), 5'000'000 + 13 * kUs);
  EXPECT_EQ(costs_.ArrivalNs(Sample(1), 4), 5'000'000 + 16 * kUs);
  EXPECT_EQ(costs_.TakeForSent(), VirtualDuration::Microseconds(16));
}

TEST_F(DdsCostsTest, SamplesOfOneTimeStampForOneProcessAreSeveral) {
  costs_.ArrivalNs(Sample(1), 2);
  costs_.ArrivalNs(Sample(1), 2);
  EXPECT_EQ(costs_.TakeForSent(), VirtualDuration::Microseconds(20));
}

TEST_F(DdsCostsTest, BestEffortHasPricesOfItsOwn) {
  costs_.ArrivalNs(Sample(1, shm::kDdsUnreliable), 2);
  costs_.ArrivalNs(Sample(1, shm::kDdsUnreliable), 3);
  EXPECT_EQ(costs_.TakeForSent(), VirtualDuration::Microseconds(15));
  EXPECT_EQ(costs_.ForReceiving(process_, Sample(1)), VirtualDuration::Microseconds(20));
  EXPECT_EQ(costs_.ForReceiving(process_, Sample(1, shm::kDdsUnreliable)),
            VirtualDuration::Microseconds(21));
}

TEST_F(DdsCostsTest, NewsCostsNothingAndDoesNotOvertakeSamples) {
  shm::DdsMessage news = Sample(1);
  news.kind = shm::DdsKind::kEndpoint;
  EXPECT_EQ(costs_.ArrivalNs(news, 2), 5'000'000);
  EXPECT_EQ(costs_.ForReceiving(process_, news), VirtualDuration());
  costs_.ArrivalNs(Sample(1), 2);
  EXPECT_EQ(costs_.ArrivalNs(news, 2), 5'000'000 + 10 * kUs);
}

TEST_F(DdsCostsTest, TheCoordinatorsOwnSamplesCostTheirReceiversOnly) {
  shm::DdsMessage own = Sample(1);
  own.from = shm::kDdsCoordinator;
  EXPECT_EQ(costs_.ArrivalNs(own, 2), 5'000'000);
  EXPECT_EQ(costs_.TakeForSent(), VirtualDuration());
  EXPECT_EQ(costs_.ForReceiving(process_, own), VirtualDuration::Microseconds(20));
}

TEST_F(DdsCostsTest, UnderSetCostsWhatProgramsComputeIsAdded) {
  by_calls_.ArrivalNs(Sample(1), 2);
  EXPECT_EQ(by_calls_.TakeForSent(), VirtualDuration::Microseconds(110));
  by_calls_.ArrivalNs(Sample(1), 3);
  EXPECT_EQ(by_calls_.TakeForSent(), VirtualDuration::Microseconds(203));
  EXPECT_EQ(by_calls_.ForReceiving(process_, Sample(1)), VirtualDuration::Microseconds(420));
}

TEST_F(DdsCostsTest, ACostOfCallsThatSomebodyHasSetHasItAlready) {
  process_.call_cost = VirtualDuration::Microseconds(7);
  by_calls_.ArrivalNs(Sample(1), 2);
  EXPECT_EQ(by_calls_.TakeForSent(), VirtualDuration::Microseconds(10));
  process_.call_cost = ClientSpec{}.fixed_call_cost;
  process_.allocation_cost = VirtualDuration();
  EXPECT_EQ(by_calls_.ForReceiving(process_, Sample(1)), VirtualDuration::Microseconds(20));
}

}  // namespace
}  // namespace tcs
