// What the engine does with threads that a test has written: each of its parts on a simulated host,
// without a process.
#include <errno.h>
#include <gtest/gtest.h>
#include <linux/futex.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/engine/deadlocks.h"
#include "coordinator/engine/wiring.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/virtual_clock.h"
#include "simbody_bridge/library/physics_library.h"
#include "tests/simulate/actions.h"
#include "tests/simulate/broken.h"
#include "tests/simulate/simulated_run.h"

// The shim's own, under other names than the C library's.
extern "C" {
int Simulated_tgkill(pid_t pid, pid_t tid, int signal);
int Simulated_kill(pid_t pid, int signal);
int Simulated_sigaction(int signal, const struct sigaction* action, struct sigaction* before);
}

namespace tcs::simulate {

void Broken(const char* what, ...) {
  va_list arguments;
  va_start(arguments, what);
  vfprintf(stderr, what, arguments);
  va_end(arguments);
  fprintf(stderr, "\n");
  abort();
}

namespace {

constexpr std::int64_t kUs = 1'000, kMs = 1'000'000, kSecond = 1'000'000'000;

void HandleBy(void (*handler)(int, siginfo_t*, void*)) {
  struct sigaction action {};
  action.sa_sigaction = handler;
  action.sa_flags = SA_SIGINFO;
  Simulated_sigaction(SIGUSR1, &action, nullptr);
}

// Robots, each with as many clients as are added; and the run's loop, step by step.
class Engine : public testing::Test {
 protected:
  struct Robots {
    int count = 1, cores = 1;
    double speed = 1.0;
    bool is_ideal = false;
    SchedulerPolicy scheduler = SchedulerPolicy::kFixedPriority;
    std::int64_t drift_ns = kMs;
    bool has_world = false;
  };
  struct Client {
    int robot = 0, priority = 0;
    VirtualDuration deadline{};
  };

  // How costs are found, and whether priorities keep threads apart.
  void Begin(const Robots& robots, bool is_fixed = true, bool has_levels = true) {
    Scenario scenario;
    scenario.duration = VirtualDuration::Seconds(7200);
    scenario.drift_bound = VirtualNs(robots.drift_ns);
    if (robots.has_world) {
      SetPhysicsLibrary(TCS_PHYSICS_LIBRARY);
      scenario.world.emplace().bodies.emplace_back().name = "ball";
    }
    for (int i = 0; i < robots.count; ++i) {
      RobotSpec& spec = scenario.robots.emplace_back();
      spec.name = "robot" + std::to_string(i);
      spec.cores = robots.cores;
      spec.speed = robots.speed;
      spec.is_ideal = robots.is_ideal;
      spec.scheduler = robots.scheduler;
    }
    run_ = std::make_unique<SimulatedRun>(std::move(scenario), ++host_, has_levels, is_fixed);
  }
  // Does that, and then sleeps for longer than the run lasts.
  Task& Add(const Client& client, std::function<void()> body) {
    ClientSpec& spec = specs_.emplace_back();
    spec.name = "robot" + std::to_string(client.robot) + "/client";
    spec.priority = client.priority;
    spec.deadline = client.deadline;
    run_->AddClient(run().robots[static_cast<std::size_t>(client.robot)], spec);
    return AddBeside(std::move(body));
  }
  // In the process that was added last.
  Task& AddBeside(std::function<void()> body) {
    return run_->AddThread([body = std::move(body)](const preload::GuestThread& guest) {
      Attach(guest);
      body();
      for (;;) SleepUntil(ReadClock() + 10'000 * kSecond);
    });
  }
  // Whether it comes to that in so many steps.
  bool StepUntil(const std::function<bool()>& is_so, int most = 50'000) {
    for (int step = 0; step < most; ++step) {
      if (is_so()) return true;
      if (!run_->all().loop.Step()) return is_so();
    }
    return false;
  }
  RunState& run() { return run_->all().run; }
  std::int64_t ComputedBy(const Task& task) const {
    return run_->kernel().OfTid(task.tid).program_ns;
  }

  std::unique_ptr<SimulatedRun> run_;

 private:
  std::deque<ClientSpec> specs_;
  std::uint64_t host_ = 0;
};

// Of costs that are set nothing but calls takes time: so sleeps end to the nanosecond.
TEST_F(Engine, IdleTimeIsJumpedOver) {
  Begin({});
  std::int64_t woke_ns = 0;
  Add({}, [&] {
    SleepUntil(3600 * kSecond);
    woke_ns = ReadClock();
  });
  const std::int64_t host_ns = run_->kernel().now_ns();
  ASSERT_TRUE(StepUntil([&] { return woke_ns != 0; }));
  EXPECT_GE(woke_ns, 3600 * kSecond);
  EXPECT_LT(woke_ns, 3600 * kSecond + 100 * kUs);
  EXPECT_LT(run_->kernel().now_ns() - host_ns, kSecond);
}

TEST_F(Engine, WhatAThreadComputesItIsCharged) {
  for (const double speed : {1.0, 0.25, 2.0}) {
    for (const bool has_levels : {true, false}) {
      run_.reset();
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
TEST_F(Engine, TheLeastAdvancedThreadActs) {
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

TEST_F(Engine, NoTurnGoesFurtherThanTheDriftBoundFromTheSlowest) {
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

TEST_F(Engine, TheMoreUrgentThreadTakesTheCoreOnceItWakes) {
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

TEST_F(Engine, TheEarlierDeadlineTakesTheCore) {
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

TEST_F(Engine, CoresComputeAtOnce) {
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

// Whom the kernel holds keeps nobody from the core, and is not earlier than others when it returns.
TEST_F(Engine, OthersGoOnWhileTheKernelHoldsAThread) {
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

TEST_F(Engine, WaitersGoOnInTheOrderInWhichTheyCame) {
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

// A dispatch is told from the one before by its number, which the thread's words carry.
TEST_F(Engine, EachDispatchHasANumber) {
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

// The handler makes a call, and is stopped in its midst and dispatched anew.
TEST_F(Engine, AWaitThatASignalEndsHasEndedWhateverTheHandlerDoes) {
  for (const bool has_levels : {true, false}) {
    run_.reset();
    Begin({.count = 2}, false, has_levels);
    bool is_over = false, was_full = true;
    std::int64_t ended_ns = 0;
    const Task& sleeps = Add({}, [&] {
      HandleBy([](int, siginfo_t*, void*) {
        SleepUntil(ReadClock() + kMs);
        Compute(5 * kMs);
      });
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
TEST_F(Engine, AWaitEndsForASignalOnlyWhereItsHandlerRuns) {
  static pid_t first;
  static int handled, handled_by_first;
  for (const bool has_levels : {true, false}) {
    run_.reset();
    handled = handled_by_first = 0;
    Begin({.count = 2, .cores = 4}, false, has_levels);
    int interrupted = 0;
    bool is_over = false;
    const Task& sleeps = Add({}, [&] {
      HandleBy([](int, siginfo_t*, void*) {
        ++handled;
        if (Kernel::This().running()->tid == first) ++handled_by_first;
      });
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

TEST_F(Engine, AProcessThatSpeaksNonsenseIsEndedAndNobodyElse) {
  Begin({.count = 2});
  bool goes_on = false, is_done = false;
  const Task& task = Add({}, [&] {
    preload::Entered guest;
    preload::Exchange(*guest.thread(), {.kind = static_cast<shm::NotificationKind>(200)});
    goes_on = true;
  });
  Add({.robot = 1}, [&] {
    SleepUntil(20 * kMs);
    is_done = true;
  });
  ASSERT_TRUE(StepUntil([&] { return is_done; }));
  EXPECT_EQ(task.state, TaskState::kDead);
  EXPECT_FALSE(goes_on);
  ASSERT_EQ(run().report.warnings.size(), 1u);
  EXPECT_NE(run().report.warnings[0].find("robot0"), std::string::npos);
}

TEST_F(Engine, TheThreadsOfAProcessThatDiesAreMissedAtOnce) {
  Begin({.count = 2}, false);
  std::int64_t other_ns = 0;
  const Task& one = Add({}, [] { Compute(kSecond); });
  const Task& beside = AddBeside([] { SleepUntil(kSecond); });
  Add({.robot = 1}, [&] {
    Compute(20 * kMs);
    other_ns = ReadClock();
  });
  ASSERT_TRUE(StepUntil([&] { return one.charged > VirtualNs(5 * kMs); }));
  run_->kernel().Kill(one.process->pid);
  ASSERT_TRUE(StepUntil([&] { return other_ns != 0; }));
  EXPECT_EQ(one.state, TaskState::kDead);
  EXPECT_EQ(beside.state, TaskState::kDead);
  EXPECT_NEAR(static_cast<double>(other_ns), 20.0 * kMs, 0.5 * kMs);
  EXPECT_LT(one.charged, VirtualNs(10 * kMs));
}

// A thread of an ideal robot takes no time. One that looks for ever whether something has come
// steps aside, and looks again once others have acted.
TEST_F(Engine, WhoLooksWithoutEndOnAnIdealRobotLetsOthersAct) {
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

// Where gates alone keep threads apart, one that hears no signal computes on when its turn is over.
// That passes first, once it has its turn again, and is charged once.
TEST_F(Engine, WhatIsComputedOutOfTurnIsADebt) {
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
  EXPECT_NEAR(static_cast<double>(deaf.charged.ns()), static_cast<double>(ComputedBy(deaf)),
              0.01 * 20 * kMs + 200 * kUs);
}

TEST_F(Engine, TheWorldStaysAsNearAsTheDriftBoundSays) {
  Begin({.has_world = true}, false);
  bool is_done = false;
  Add({}, [&] {
    for (int i = 0; i < 10; ++i) {
      Compute(3 * kMs);
      SleepUntil(ReadClock() + 2 * kMs);
    }
    is_done = true;
  });
  VirtualDuration most;
  ASSERT_TRUE(StepUntil([&] {
    most = std::max(most, run().root.drift());
    return is_done;
  }));
  EXPECT_LE(most, VirtualNs(kMs));
  EXPECT_GE(run_->all().world.progress(), VirtualTime() + VirtualNs(48 * kMs));
}

// As the C library's mutexes say who has them.
TEST_F(Engine, ARingOfThreadsThatWaitForEachOthersLocksIsNamed) {
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
  const auto found = [&] { return DeadlocksIn(run(), run_->all().words.table()); };
  EXPECT_TRUE(found().empty());
  ASSERT_TRUE(StepUntil([&] {
    return one.Awaits<awaited::Futex>() != nullptr && other.Awaits<awaited::Futex>() != nullptr;
  }));
  ASSERT_EQ(found().size(), 1u);
  EXPECT_NE(found()[0].find("robot0/client waits for a lock that robot0/client #1 has"),
            std::string::npos)
      << found()[0];
}

// Of set costs the same course on each host, whatever that does.
TEST_F(Engine, ARunOfSetCostsIsTheSameOnEachHost) {
  std::vector<std::vector<std::int64_t>> courses;
  for (const bool has_levels : {true, true, false, false}) {
    run_.reset();
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
