// A robot of a few threads, as tests of its scheduler need it: what each waits for is a table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "coordinator/policy/robot_scheduler.h"

namespace tcs {

constexpr int kOne = 1, kTwo = 2;
constexpr SchedulingParameters kOrdinary{}, kBatch{.policy = SCHED_BATCH},
    kIdle{.policy = SCHED_IDLE}, kFifo50{.policy = SCHED_FIFO, .priority = 50},
    kFifo60{.policy = SCHED_FIFO, .priority = 60}, kRoundRobin{.policy = SCHED_RR, .priority = 50};
constexpr std::int64_t kMicro = 1'000, kMilli = 1'000'000;
constexpr std::int64_t kNever = RobotScheduler::kNever.ns();

class SimulatedRobot {
 public:
  using Thread = RobotScheduler::Thread;
  using Wait = RobotScheduler::Wait;

  explicit SimulatedRobot(std::size_t cores = 1, bool preempts_on_wakeup = true,
                          std::optional<std::uint64_t> turns_seed = std::nullopt)
      : scheduler(
            cores, preempts_on_wakeup,
            [this](Thread thread) {
              ++asked;
              return waits[thread];
            },
            turns_seed),
        progress_(cores, 0) {}
  SimulatedRobot(const SimulatedRobot&) = delete;
  SimulatedRobot& operator=(const SimulatedRobot&) = delete;

  // Each thread is a process of its own, which waits for nothing.
  void Add(Thread thread, SchedulingParameters parameters = {}, int client_priority = 0) {
    scheduler.Add(thread, client_priority);
    waits[thread].process = static_cast<std::uint32_t>(thread);
    scheduler.SetParameters(thread, parameters, {});
    scheduler.FindEffectivePriority(thread);
  }
  void AddReady(Thread thread, SchedulingParameters parameters = {}, int client_priority = 0) {
    Add(thread, parameters, client_priority);
    scheduler.Enqueue(thread, RobotTime(0), false);
    scheduler.Assign(RobotTime(kNever));
  }
  void Sleep(Thread thread, Wait wait) {
    wait.process = waits[thread].process;
    wait.waits = true;
    waits[thread] = wait;
    scheduler.Dequeue(thread);
    scheduler.Assign(RobotTime(kNever));
  }
  void Wake(Thread thread, std::int64_t at_ns, bool goes_first) {
    waits[thread] = {.process = waits[thread].process};
    scheduler.WakeUp(thread, RobotTime(at_ns), true);
    scheduler.Enqueue(thread, RobotTime(at_ns), goes_first);
    scheduler.Assign(RobotTime(kNever));
  }
  void SetExpiry(Thread thread, std::int64_t ns) {
    waits[thread].next_expiry = RobotTime(ns);
    scheduler.ExpiryChanged(waits[thread].process);
    scheduler.Assign(RobotTime(kNever));
  }
  Thread Next(std::size_t core = 0) const { return scheduler.Next(core).thread; }
  std::int64_t Progress(std::size_t core = 0) const { return progress_[core]; }
  void ComeTo(std::size_t core, std::int64_t ns) {
    progress_[core] = ns;
    scheduler.SetProgress(core, RobotTime(ns));
    scheduler.Assign(RobotTime(kNever));
  }
  // The core's thread runs for so long, and its equals have the next turn if its own is over.
  void Run(std::int64_t ns, std::size_t core = 0) {
    const Thread thread = Next(core);
    scheduler.Dispatch(core, thread);
    ComeTo(core, progress_[core] + ns);
    scheduler.Enqueue(thread, RobotTime(progress_[core]), false);
    scheduler.Stop(core, VirtualNs(ns), VirtualNs(ns));
    scheduler.Enqueue(thread, RobotTime(progress_[core]), false);
    scheduler.EndTurn(core);
    scheduler.Assign(RobotTime(kNever));
  }
  std::int64_t Horizon(const RobotScheduler::Outlook& outlook = {}, std::size_t core = 0,
                       std::int64_t limit_ns = kNever) const {
    return scheduler.HorizonOf(core, Next(core), RobotTime(limit_ns), outlook).run.ns();
  }

  std::map<Thread, Wait> waits;
  int asked = 0;  // how often the scheduler has asked what a thread waits for
  RobotScheduler scheduler;

 private:
  std::vector<std::int64_t> progress_;
};

}  // namespace tcs
