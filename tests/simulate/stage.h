// For unit tests of the engine: robots, threads that do what a test has written, and the run's
// loop, step by step, on a simulated host.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>

#include "coordinator/engine/wiring.h"
#include "tests/simulate/actions.h"
#include "tests/simulate/simulated_run.h"

namespace tcs::simulate {

inline constexpr std::int64_t kUs = 1'000, kMs = 1'000'000, kSecond = 1'000'000'000;

class Stage : public testing::Test {
 protected:
  struct Robots {
    int count = 1, cores = 1;
    double speed = 1.0;
    WakeupSpec wakeup{};
    bool is_ideal = false;
    SchedulerPolicy scheduler = SchedulerPolicy::kFixedPriority;
    std::int64_t drift_ns = kMs;
    bool has_world = false;
  };
  struct Client {
    int robot = 0, priority = 0;
    VirtualDuration deadline{};
  };

  // Anew, on another host each time. `is_fixed`: how costs are found; `has_levels`: priorities keep
  // threads apart.
  void Begin(const Robots& robots, bool is_fixed = true, bool has_levels = true);
  // A thread of a new process, which does that, and then sleeps for longer than the run lasts.
  Task& Add(const Client& client, std::function<void()> body);
  // In the process that was added last.
  Task& AddBeside(std::function<void()> body);
  // Whether it comes to that in so many steps.
  bool StepUntil(const std::function<bool()>& is_so, int most = 50'000);

  Wiring& all() { return run_->all(); }
  RunState& run() { return run_->all().run; }
  Kernel& kernel() { return run_->kernel(); }

 private:
  std::unique_ptr<SimulatedRun> run_;
  std::deque<ClientSpec> specs_;
  std::uint64_t hosts_ = 0;
};

}  // namespace tcs::simulate
