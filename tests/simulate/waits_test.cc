// Waits: in what order they end, by what, and what others do meanwhile.
#include <errno.h>
#include <gtest/gtest.h>
#include <linux/futex.h>
#include <signal.h>

#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/engine/deadlocks.h"
#include "tests/simulate/stage.h"

namespace tcs::simulate {
namespace {

class EngineWaits : public Stage {};

// Of costs that are set nothing but calls takes time: so sleeps end to the nanosecond.
TEST_F(EngineWaits, IdleTimeIsJumpedOver) {
  Begin({});
  std::int64_t woke_ns = 0;
  Add({}, [&] {
    SleepUntil(3600 * kSecond);
    woke_ns = ReadClock();
  });
  const std::int64_t host_ns = kernel().now_ns();
  ASSERT_TRUE(StepUntil([&] { return woke_ns != 0; }));
  EXPECT_GE(woke_ns, 3600 * kSecond);
  EXPECT_LT(woke_ns, 3600 * kSecond + 100 * kUs);
  EXPECT_LT(kernel().now_ns() - host_ns, kSecond);
}

// A thread is ready so much after what it has waited for; until then others have the core.
TEST_F(EngineWaits, TheKernelTakesItsTimeToWakeAThread) {
  constexpr VirtualDuration kWakeup = VirtualDuration::Microseconds(300);
  for (const bool is_fixed : {true, false}) {
    Begin({.wakeup = {kWakeup, kWakeup}}, is_fixed);
    std::vector<std::int64_t> late_ns;
    std::int64_t other_ns = 0, wakes_ns = 0, woken_ns = 0;
    std::atomic<std::uint32_t> word{0};
    Add({.priority = 10}, [&] {
      for (int i = 1; i <= 10; ++i) {
        SleepUntil(i * kMs);
        late_ns.push_back(ReadClock() - i * kMs);
      }
      EXPECT_EQ(Futex(word, FUTEX_WAIT, 0), 0);
      woken_ns = ReadClock();
    });
    AddBeside([&] {
      Compute(is_fixed ? 0 : 8 * kMs);
      other_ns = ReadClock();
      SleepUntil(20 * kMs);
      wakes_ns = ReadClock();
      EXPECT_EQ(Futex(word, FUTEX_WAKE, 1), 1);
    });
    ASSERT_TRUE(StepUntil([&] { return woken_ns != 0; }));
    ASSERT_EQ(late_ns.size(), 10u);
    for (const std::int64_t ns : late_ns) {
      EXPECT_GE(ns, kWakeup.ns());
      EXPECT_LT(ns, kWakeup.ns() + 30 * kUs);
    }
    EXPECT_GE(woken_ns - wakes_ns, kWakeup.ns());
    EXPECT_LT(woken_ns - wakes_ns, kWakeup.ns() + 50 * kUs);
    // Nobody computes while the kernel wakes somebody, and nobody has to wait for that.
    if (!is_fixed) {
      EXPECT_NEAR(static_cast<double>(other_ns), 8.0 * kMs, 0.5 * kMs);
    }
  }
}

// Whom the kernel holds keeps nobody from the core, and is not earlier than others when it returns.
TEST_F(EngineWaits, OthersGoOnWhileTheKernelHoldsAThread) {
  Begin({}, false);
  std::int64_t held_ns = 0, other_ns = 0;
  bool was_unseen = false, others_had_ended = false;
  const Task& held = Add({.priority = 10}, [&] {
    Kernel::This().BlockFor(20 * kMs);
    others_had_ended = other_ns != 0;
    held_ns = ReadClock();
  });
  Add({}, [&] {
    Compute(2 * kMs);
    other_ns = ReadClock();
    Compute(60 * kMs);  // the run goes on
  });
  ASSERT_TRUE(StepUntil([&] {
    was_unseen = was_unseen || held.state == TaskState::kUnseen;
    return held_ns != 0 && other_ns != 0;
  }));
  EXPECT_TRUE(was_unseen && others_had_ended);
  EXPECT_NEAR(static_cast<double>(other_ns), 2.0 * kMs, 0.5 * kMs);
  EXPECT_GE(held_ns, other_ns);
}

TEST_F(EngineWaits, WaitersGoOnInTheOrderInWhichTheyCame) {
  Begin({.cores = 4});
  std::atomic<std::uint32_t> word{0};
  std::vector<std::pair<int, std::int64_t>> woken;
  std::int64_t wakes_ns = 0;
  const auto waits = [&](int number) {
    return [&, number] {
      SleepUntil(number * kMs);
      EXPECT_EQ(Futex(word, FUTEX_WAIT, 0), 0);
      woken.emplace_back(number, ReadClock());
    };
  };
  Add({}, waits(1));
  AddBeside(waits(2));
  AddBeside(waits(3));
  AddBeside([&] {
    // Nobody has changed the word, whatever this one thinks that it was.
    EXPECT_EQ(Futex(word, FUTEX_WAIT, 1), -EAGAIN);
    SleepUntil(50 * kMs);
    wakes_ns = ReadClock();
    EXPECT_EQ(Futex(word, FUTEX_WAKE, 2), 2);
    EXPECT_EQ(Futex(word, FUTEX_WAKE, 2), 1);
    EXPECT_EQ(Futex(word, FUTEX_WAKE, 2), 0);
  });
  ASSERT_TRUE(StepUntil([&] { return woken.size() == 3; }));
  // The two that one call has woken go on at once.
  EXPECT_EQ(woken[0].first + woken[1].first, 1 + 2);
  EXPECT_EQ(woken[2].first, 3);
  for (const auto& [number, ns] : woken) {
    EXPECT_GE(ns, wakes_ns) << number;
    EXPECT_LT(ns, wakes_ns + kMs) << number;
  }
}

// Handlers ask the coordinator for the time, which has its answer, and make calls past the shim.
TEST_F(EngineWaits, AWaitThatHandlersEndHasEndedWhateverTheyCall) {
  for (const bool has_levels : {true, false}) {
    for (const bool is_fixed : {true, false}) {
      Begin({.count = 2}, is_fixed, has_levels);
      bool is_over = false, was_full = true;
      std::int64_t ended_ns = 0;
      static std::atomic<std::uint32_t> word;
      const Task& sleeps = Add({}, [&] {
        HandleBy(
            SIGUSR1,
            [](int, siginfo_t*, void*) {
              SleepUntil(ReadClock() + kMs);
              Futex(word, FUTEX_WAKE, 1);
              Futex(word, FUTEX_WAKE, 1);
            },
            0);
        was_full = SleepUntil(kSecond);
        ended_ns = ReadClock();
        is_over = true;
      });
      Add({.robot = 1}, [&] {
        SleepUntil(20 * kMs);
        Simulated_tgkill(sleeps.process->pid, sleeps.tid, SIGUSR1);
      });
      ASSERT_TRUE(StepUntil([&] { return is_over; }));
      EXPECT_FALSE(was_full) << has_levels << is_fixed;
      EXPECT_GE(ended_ns, 21 * kMs);
      EXPECT_LT(ended_ns, 30 * kMs);
    }
  }
}

// The handler makes a call, and is stopped in its midst and dispatched anew.
TEST_F(EngineWaits, AWaitThatASignalEndsHasEndedWhateverTheHandlerDoes) {
  for (const bool has_levels : {true, false}) {
    Begin({.count = 2}, false, has_levels);
    bool is_over = false, was_full = true;
    std::int64_t ended_ns = 0;
    const Task& sleeps = Add({}, [&] {
      HandleBy(
          SIGUSR1,
          [](int, siginfo_t*, void*) {
            SleepUntil(ReadClock() + kMs);
            Compute(5 * kMs);
          },
          0);
      was_full = SleepUntil(kSecond);
      ended_ns = ReadClock();
      is_over = true;
    });
    Add({.robot = 1}, [&] {
      SleepUntil(10 * kMs);
      Simulated_tgkill(sleeps.process->pid, sleeps.tid, SIGUSR1);
      Compute(30 * kMs);
    });
    ASSERT_TRUE(StepUntil([&] { return is_over; }));
    EXPECT_FALSE(was_full);
    EXPECT_NEAR(static_cast<double>(ended_ns), 16.0 * kMs, 1.0 * kMs);
  }
}

// A signal for a process is taken by the thread of it that has the processor first. Another one
// that was to be woken for it sleeps on.
TEST_F(EngineWaits, AWaitEndsForASignalOnlyWhereItsHandlerRuns) {
  static pid_t first;
  static int handled, handled_by_first;
  for (const bool has_levels : {true, false}) {
    handled = handled_by_first = 0;
    Begin({.count = 2, .cores = 4}, false, has_levels);
    int interrupted = 0;
    bool is_over = false;
    const Task& sleeps = Add({}, [&] {
      HandleBy(
          SIGUSR1,
          [](int, siginfo_t*, void*) {
            ++handled;
            if (Kernel::This().running()->tid == first) ++handled_by_first;
          },
          0);
      while (ReadClock() < kSecond) {
        if (!SleepUntil(ReadClock() + 30 * kMs)) ++interrupted;
      }
      is_over = true;
    });
    first = sleeps.tid;
    for (int i = 0; i < 3; ++i) {
      AddBeside([] {
        for (;;) SleepUntil(ReadClock() + 90 * kUs);
      });
    }
    Add({.robot = 1}, [&] {
      for (;;) {
        SleepUntil(ReadClock() + 1'700 * kUs);
        Simulated_kill(sleeps.process->pid, SIGUSR1);
      }
    });
    ASSERT_TRUE(StepUntil([&] { return is_over; }, 500'000));
    EXPECT_GT(handled, 20);
    EXPECT_LE(interrupted, handled_by_first);
  }
}

// A thread of an ideal robot takes no time. One that looks for ever whether something has come
// steps aside, and looks again once others have acted.
TEST_F(EngineWaits, WhoLooksWithoutEndOnAnIdealRobotLetsOthersAct) {
  Begin({.count = 2, .is_ideal = true});
  bool is_there = false;
  std::int64_t seen_ns = 0;
  const Task& looks = Add({}, [&] {
    while (!is_there) Compute(kUs);
    seen_ns = ReadClock();
  });
  Add({.robot = 1}, [&] {
    SleepUntil(5 * kMs);
    is_there = true;
  });
  ASSERT_TRUE(StepUntil([&] { return seen_ns != 0; }));
  EXPECT_NEAR(static_cast<double>(seen_ns), 5.0 * kMs, 1.0 * kMs);
  EXPECT_EQ(looks.charged, VirtualDuration());
}

// As the C library's mutexes say who has them.
TEST_F(EngineWaits, ARingOfThreadsThatWaitForEachOthersLocksIsNamed) {
  struct Mutex {
    std::atomic<std::uint32_t> word{2};
    std::int32_t count = 0, owner = 0;
  };
  static_assert(sizeof(Mutex) == 12);
  Begin({});
  Mutex locks[2];
  const auto takes = [&](int own, int other) {
    return [&, own, other] {
      locks[own].owner = Kernel::This().running()->tid;
      SleepUntil(kMs);
      Futex(locks[other].word, FUTEX_WAIT, 2);
    };
  };
  const Task& one = Add({}, takes(0, 1));
  const Task& other = AddBeside(takes(1, 0));
  const auto found = [&] { return DeadlocksIn(run(), all().words.table()); };
  EXPECT_TRUE(found().empty());
  ASSERT_TRUE(StepUntil([&] {
    return one.Awaits<awaited::Futex>() != nullptr && other.Awaits<awaited::Futex>() != nullptr;
  }));
  ASSERT_EQ(found().size(), 1u);
  EXPECT_NE(found()[0].find("robot0/client waits for a lock that robot0/client #1 has"),
            std::string::npos)
      << found()[0];
}

}  // namespace
}  // namespace tcs::simulate
