// Turns: who has the next one, how far it goes, and what its thread is charged for it.
#include <gtest/gtest.h>
#include <linux/futex.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "libtcs_preload/virtual_clock.h"
#include "tests/simulate/stage.h"

namespace tcs::simulate {
namespace {

class EngineTurns : public Stage {};

TEST_F(EngineTurns, WhatAThreadComputesItIsCharged) {
  for (const double speed : {1.0, 0.25, 2.0}) {
    for (const bool has_levels : {true, false}) {
      Begin({.speed = speed}, false, has_levels);
      std::int64_t took_ns = 0;
      const Task& task = Add({}, [&] {
        const std::int64_t begun_ns = ReadClock();
        Compute(40 * kMs);
        took_ns = ReadClock() - begun_ns;
      });
      ASSERT_TRUE(StepUntil([&] { return task.state == TaskState::kWaiting; }));
      const double wanted_ns = 40.0 * kMs / speed;
      EXPECT_NEAR(static_cast<double>(took_ns), wanted_ns, 0.01 * wanted_ns + 200 * kUs);
      EXPECT_NEAR(static_cast<double>(task.charged.ns()), wanted_ns, 0.01 * wanted_ns + 200 * kUs);
    }
  }
}

// What others can see of them happens in the order of virtual time.
TEST_F(EngineTurns, TheLeastAdvancedThreadActs) {
  Begin({.count = 2}, false);
  std::vector<std::int64_t> shown;
  const auto computes = [&](std::int64_t each_ns) {
    return [&shown, each_ns] {
      for (int i = 0; i < 40; ++i) {
        Compute(each_ns);
        const preload::Entered guest;
        preload::HoldForRead(*guest.thread());
        shown.push_back(preload::NowNs(*guest.thread()));
      }
    };
  };
  const Task& one = Add({.robot = 0}, computes(3 * kMs));
  const Task& other = Add({.robot = 1}, computes(700 * kUs));
  ASSERT_TRUE(StepUntil(
      [&] { return one.state == TaskState::kWaiting && other.state == TaskState::kWaiting; }));
  ASSERT_EQ(shown.size(), 80u);
  // What a look at the clock itself takes is nobody's.
  for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_GE(shown[i], shown[i - 1] - 2 * kUs) << i;
}

TEST_F(EngineTurns, NoTurnGoesFurtherThanTheDriftBoundFromTheSlowest) {
  Begin({.count = 3, .drift_ns = 300 * kUs}, false);
  int done = 0;
  for (int robot = 0; robot < 3; ++robot) {
    Add({.robot = robot}, [&done, robot] {
      Compute((10 + robot) * kMs);
      ++done;
    });
  }
  VirtualDuration most;
  ASSERT_TRUE(StepUntil([&] {
    most = std::max(most, run().root.drift());
    return done == 3;
  }));
  EXPECT_LE(most, VirtualNs(300 * kUs));
  EXPECT_GT(most, VirtualDuration());
}

TEST_F(EngineTurns, TheMoreUrgentThreadTakesTheCoreOnceItWakes) {
  Begin({}, false);
  std::int64_t urgent_ns = 0, other_ns = 0;
  Add({.priority = 10}, [&] {
    SleepUntil(10 * kMs);
    Compute(5 * kMs);
    urgent_ns = ReadClock();
  });
  Add({.priority = 0}, [&] {
    Compute(50 * kMs);
    other_ns = ReadClock();
  });
  ASSERT_TRUE(StepUntil([&] { return urgent_ns != 0 && other_ns != 0; }));
  EXPECT_NEAR(static_cast<double>(urgent_ns), 15.0 * kMs, 0.5 * kMs);
  EXPECT_NEAR(static_cast<double>(other_ns), 55.0 * kMs, 0.5 * kMs);
}

TEST_F(EngineTurns, TheEarlierDeadlineTakesTheCore) {
  Begin({.scheduler = SchedulerPolicy::kEarliestDeadlineFirst}, false);
  std::vector<int> ended;
  Add({.deadline = VirtualDuration::Milliseconds(100)}, [&] {
    Compute(8 * kMs);
    ended.push_back(100);
  });
  Add({.deadline = VirtualDuration::Milliseconds(20)}, [&] {
    Compute(8 * kMs);
    ended.push_back(20);
  });
  ASSERT_TRUE(StepUntil([&] { return ended.size() == 2; }));
  EXPECT_EQ(ended, (std::vector<int>{20, 100}));
}

TEST_F(EngineTurns, CoresComputeAtOnce) {
  Begin({.cores = 2}, false);
  std::vector<std::int64_t> ended_ns;
  const auto computes = [&] {
    Compute(10 * kMs);
    ended_ns.push_back(ReadClock());
  };
  Add({}, computes);
  AddBeside(computes);
  ASSERT_TRUE(StepUntil([&] { return ended_ns.size() == 2; }));
  for (const std::int64_t ns : ended_ns)
    EXPECT_NEAR(static_cast<double>(ns), 10.0 * kMs, 0.5 * kMs);
}

// A dispatch is told from the one before by its number, which the thread's words carry.
TEST_F(EngineTurns, EachDispatchHasANumber) {
  Begin({.count = 2}, false);
  bool is_done = false;
  const Task& task = Add({}, [&] {
    Compute(10 * kMs);
    is_done = true;
  });
  Add({.robot = 1}, [] { Compute(10 * kMs); });
  std::vector<std::uint64_t> numbers;
  ASSERT_TRUE(StepUntil([&] {
    const std::uint64_t number = task.dispatches;
    if (numbers.empty() || numbers.back() != number) numbers.push_back(number);
    return is_done;
  }));
  // Each thread may be a millisecond ahead of the other one.
  EXPECT_GE(numbers.size(), 5u);
  EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
}

// Where gates alone keep threads apart, one that hears no signal computes on when its turn is over.
// That passes first, once it has its turn again, and is charged once.
TEST_F(EngineTurns, WhatIsComputedOutOfTurnIsADebt) {
  Begin({.count = 2}, false, false);
  bool is_done = false;
  std::int64_t took_ns = 0;
  const Task& deaf = Add({}, [&] {
    Kernel::This().SetBlocked(~std::uint64_t{0});
    const std::int64_t begun_ns = ReadClock();
    Compute(20 * kMs);
    took_ns = ReadClock() - begun_ns;
    is_done = true;
  });
  Add({.robot = 1}, [] {
    for (;;) SleepUntil(ReadClock() + 100 * kUs);
  });
  VirtualDuration most_debt;
  ASSERT_TRUE(StepUntil([&] {
    most_debt = std::max(most_debt, deaf.debt);
    return is_done && deaf.state == TaskState::kWaiting;
  }));
  EXPECT_GT(most_debt, VirtualNs(500 * kUs));
  EXPECT_NEAR(static_cast<double>(took_ns), 20.0 * kMs, 0.01 * 20 * kMs + 200 * kUs);
  EXPECT_NEAR(static_cast<double>(deaf.charged.ns()),
              static_cast<double>(kernel().Find(deaf.tid)->program_ns),
              0.01 * 20 * kMs + 200 * kUs);
}

// Its message has been read, and the coordinator looks once more before the turn ends. In that look
// the detector tells that the thread sleeps: it waits for the answer, and nobody has cut it off.
TEST_F(EngineTurns, AThreadThatHasSpokenIsNotTakenToBeCutOff) {
  for (const bool has_levels : {true, false}) {
    Begin({}, false, has_levels);
    Task& task = Add({}, [] {});
    Add({}, [] { Compute(10 * kMs); });  // the steps go on
    ASSERT_TRUE(StepUntil([&] {
      return task.state == TaskState::kWaiting &&
             task.slot_memory->gate.load() == shm::kGateWaiting;
    }));
    task.parked = false;
    run().turn.Begin(task, VirtualTime());
    run().turn.notified = true;
    EXPECT_FALSE(all().block_detection.LetsOthersRun());
    EXPECT_NE(task.slot_memory->wake_reason.load(), shm::WakeReason::kCutOff);
    EXPECT_FALSE(task.is_cut_off);
    run().turn.End();
    task.parked = true;
  }
}

// Of set costs the same course on each host, whatever that does.
TEST_F(EngineTurns, ARunOfSetCostsIsTheSameOnEachHost) {
  std::vector<std::vector<std::int64_t>> courses;
  for (const bool has_levels : {true, true, false, false}) {
    Begin({.count = 2, .cores = 2}, true, has_levels);
    std::vector<std::int64_t>& shown = courses.emplace_back();
    std::atomic<std::uint32_t> word{0};
    int done = 0;
    const auto works = [&] {
      for (int i = 0; i < 20; ++i) {
        SleepUntil(ReadClock() + 130 * kUs);
        if (i % 5 == 0) Futex(word, FUTEX_WAKE, 1);
      }
      shown.push_back(ReadClock());
      ++done;
    };
    Add({}, works);
    AddBeside(works);
    Add({.robot = 1}, works);
    ASSERT_TRUE(StepUntil([&] { return done == 3; }));
    std::sort(shown.begin(), shown.end());
  }
  for (std::size_t i = 1; i < courses.size(); ++i) EXPECT_EQ(courses[i], courses[0]) << i;
}

}  // namespace
}  // namespace tcs::simulate
