#include "coordinator/processes/slot_check.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "coordinator/tasks/task_table.h"

namespace tcs {
namespace {

constexpr std::int64_t kMillisecondNs = 1'000'000, kSecondNs = 1'000'000'000;

// A thread that was given a clock from 1 s on, with a horizon at 1.01 s, and has stopped.
class SlotCheckTest : public testing::Test {
 protected:
  SlotCheckTest() {
    task_.process = &process_;
    task_.slot_memory = slot_.get();
    task_.metered.page_origin_ns = 5 * kMillisecondNs;
    page().host_cpu_origin_ns = 5 * kMillisecondNs;
    task_.grant.base_time_ns = kSecondNs;
    task_.grant.horizon_ns = kSecondNs + 10 * kMillisecondNs;
    task_.grant.most_idle_ns = kSecondNs + 4 * kMillisecondNs;
    task_.grant.read_safe_ns = kSecondNs + 7 * kMillisecondNs;
    task_.grant.NoteLimits();
    task_.grant.WriteTo(page());
    page().last_shown_ns.store(kSecondNs + 10 * kMillisecondNs);
    page().staleness_ns.store(3 * kMillisecondNs);
    page().stolen_ns.store(2 * kSecondNs);
  }
  shm::ClockPage& page() { return slot_->clock; }
  // What is found wrong, or nothing.
  std::string Measured() { return Found(measured_); }
  std::string Fixed() { return Found(fixed_); }

  std::string Found(const SlotCheck& check) {
    const char* what = check.WhatIsImpossible(task_, page());
    return what == nullptr ? "" : what;
  }

  Robot robot_{"robot", 1.0, RobotScheduler(1, true, [](int) { return RobotScheduler::Wait{}; })};
  Process process_;
  std::unique_ptr<shm::ThreadSlot> slot_ = std::make_unique<shm::ThreadSlot>();
  Task task_;
  std::int64_t run_ns_ = 2 * kSecondNs;
  SlotCheck measured_{false, [this] { return run_ns_; }}, fixed_{true, [this] { return run_ns_; }};

 private:
  void SetUp() override { process_.robot = &robot_; }
};

TEST_F(SlotCheckTest, WhatAThreadCanHaveMadeOfItsClockIsPossible) {
  EXPECT_EQ(Measured(), "");
  EXPECT_EQ(Fixed(), "");
}

TEST_F(SlotCheckTest, AClockThatIsNotTheOneGivenIsNot) {
  page().horizon_ns += 1;
  EXPECT_EQ(Measured(), "the clock that it was given");
}

TEST_F(SlotCheckTest, NoClockShowsATimeBeyondItsHorizon) {
  page().last_shown_ns.store(kSecondNs + 10 * kMillisecondNs + 1);
  EXPECT_EQ(Measured(), "a time beyond what it was given");
}

TEST_F(SlotCheckTest, NobodySleepsLongerThanItMay) {
  page().waited_adjust.store(14 * kMillisecondNs);
  EXPECT_EQ(Measured(), "");  // what clocks differ by
  page().waited_adjust.store(14 * kMillisecondNs + 1);
  EXPECT_EQ(Measured(), "a sleep beyond what it was allowed");
}

TEST_F(SlotCheckTest, NothingIsOlderThanWhatCouldBeRead) {
  page().staleness_ns.store(3 * kMillisecondNs + 1);
  EXPECT_EQ(Measured(), "data older than any can be");
  EXPECT_EQ(SlotCheck::StalenessOf(task_), 0);
  page().staleness_ns.store(3 * kMillisecondNs);
  EXPECT_EQ(SlotCheck::StalenessOf(task_), 3 * kMillisecondNs);
}

TEST_F(SlotCheckTest, NoMoreIsStolenThanTimeHasPassed) {
  run_ns_ = kSecondNs - 1;  // and a second of slack
  EXPECT_EQ(Measured(), "more stolen than there was");
  EXPECT_EQ(measured_.StolenOf(task_), 0);
  run_ns_ = kSecondNs;
  EXPECT_EQ(Measured(), "");
  EXPECT_EQ(measured_.StolenOf(task_), 2 * kSecondNs);
}

TEST_F(SlotCheckTest, NoClockGoesAheadByMoreTimeThanHasPassed) {
  page().executed_adjust.store(static_cast<std::uint64_t>(3 * kSecondNs));
  EXPECT_EQ(Measured(), "");
  page().executed_adjust.store(static_cast<std::uint64_t>(3 * kSecondNs + 1));
  EXPECT_EQ(Measured(), "a clock that went ahead");
  EXPECT_EQ(Fixed(), "");
}

TEST_F(SlotCheckTest, OnAFasterRobotTheSameIsMoreOfTheHostsTime) {
  robot_.speed = 2.0;
  EXPECT_EQ(Measured(), "more stolen than there was");
  run_ns_ = 3 * kSecondNs;
  EXPECT_EQ(Measured(), "");
}

TEST_F(SlotCheckTest, AThreadNotifiesOnlyWhatThereIs) {
  shm::Notification note{};
  note.kind = shm::NotificationKind::kRead;
  EXPECT_EQ(SlotCheck::WhatIsImpossible(note), nullptr);
  note.fd_count = shm::kMaxWaitFds + 1;
  EXPECT_STREQ(SlotCheck::WhatIsImpossible(note), "a wait for too many descriptors");
  note.fd_count = 0;
  note.kind = static_cast<shm::NotificationKind>(0xffff);
  EXPECT_STREQ(SlotCheck::WhatIsImpossible(note), "a notification of no kind");
}

}  // namespace
}  // namespace tcs
