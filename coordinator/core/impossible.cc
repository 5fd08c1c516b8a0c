// What a process can write into the memory that it shares with the coordinator, and cannot mean:
// then a pointer has gone astray there, or the program means harm. It is ended; the run goes on.
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "shm/clock_page.h"

namespace tcs {

namespace {

// More than what clocks and the coordinator's estimates differ by in one dispatch.
constexpr std::int64_t kSlackNs = 10'000'000;
// More than all ways out of gates in one dispatch take, and than the TSC can miss.
constexpr std::int64_t kLargeSlackNs = 1'000'000'000;
constexpr int kDeathMs = 1000;

}  // namespace

// Of the clock of a thread that has just been stopped; null if all is well.
const char* Engine::WhatIsImpossible(const Task& task) const {
  const shm::ClockPage& page = Slot(task).clock;
  if (!task.HasOwnClock()) return "the clock that it was given";
  const ClockGrant& grant = task.grant;
  const std::int64_t moved = page.host_cpu_origin_ns - task.metered.page_origin_ns;
  if (moved < 0 || moved > kLargeSlackNs) return "its processor clock";
  const std::int64_t added = shm::AdjustValue(page.executed_adjust.load());
  const std::int64_t waited = shm::AdjustValue(page.waited_adjust.load());
  if (IsFixed() && added < -kSlackNs) return "a clock that went back";
  if (!IsFixed() && added > kLargeSlackNs) return "a clock that went ahead";
  const std::int64_t idle = std::max<std::int64_t>(0, grant.most_idle_ns - grant.base_time_ns);
  if (waited < 0 || waited > idle + kSlackNs) return "a sleep beyond what it was allowed";
  if (page.last_shown_ns.load() > grant.most_shown_ns) return "a time beyond what it was given";
  const std::int64_t stale = page.staleness_ns.load();
  if (stale < 0 || stale > grant.most_stale_ns) return "data older than any can be";
  if (StolenOf(task) != page.stolen_ns.load()) return "more stolen than there was";
  return nullptr;
}

// Of what a thread notifies.
const char* Engine::WhatIsImpossible(const shm::Notification& note) {
  using Kind = shm::NotificationKind;
  const auto kind = static_cast<std::uint32_t>(note.kind);
  const bool is_known = kind >= static_cast<std::uint32_t>(Kind::kHorizon) &&
                        kind <= static_cast<std::uint32_t>(Kind::kKernelWait) && kind != 16 &&
                        note.kind != Kind::kResumed;
  if (!is_known && note.kind != Kind::kPassOn && note.kind != Kind::kCall &&
      note.kind != Kind::kPreempted)
    return "a notification of no kind";
  if (note.fd_count > shm::kMaxWaitFds) return "a wait for too many descriptors";
  if (note.kind != Kind::kTimerCreate) return nullptr;
  shm::TimerKind timer;
  memcpy(static_cast<void*>(&timer), &note.args[1], sizeof timer);
  const bool is_timer = timer.clock <= shm::TimerClock::kThreadCpu && timer.is_posix <= 1 &&
                        timer.signal >= 0 && timer.signal <= SIGRTMAX;
  return is_timer ? nullptr : "a timer of no kind";
}

// What was stolen from it, as far as that can be true.
std::int64_t Engine::StolenOf(const Task& task) const {
  const std::int64_t stolen = Slot(task).clock.stolen_ns.load();
  const auto since_start =
      shm::MulQ32(static_cast<std::int64_t>(host_cpu_.stop_tsc() - start_tsc_), ns_per_tick_q32_);
  const double most = static_cast<double>(since_start + kLargeSlackNs) / task.process->robot->speed;
  return stolen >= 0 && static_cast<double>(stolen) <= most ? stolen : 0;
}

std::int64_t Engine::StalenessOf(const Task& task) const {
  const std::int64_t stale = Slot(task).clock.staleness_ns.load();
  return stale >= 0 && stale <= task.grant.most_stale_ns ? stale : 0;
}

// Its threads get to the end at once, and nobody runs meanwhile: it takes the kernel some steps.
void Engine::Expel(Process& process, const char* what) {
  if (std::exchange(process.expelled, true)) return;
  if (!std::exchange(process.client->has_erred, true))
    Warn(
        fmt::format("{} (pid {}) has written what cannot be into the memory that it shares with "
                    "tcs ({}), and was ended; look for a pointer gone astray in it",
                    process.name, process.pid, what));
  syscall(SYS_pidfd_send_signal, process.pidfd.get(), SIGKILL, nullptr, 0);
  const std::vector<Task*> threads = process.robot->tasks;
  for (Task* task : threads) {
    if (task->process != &process) continue;
    host_cpu_.active().LetRun(*task);
    if (!turn_.IsOf(*task)) AwaitDeath(*task);
  }
  pollfd end{process.pidfd.get(), POLLIN, 0};
  poll(&end, 1, kDeathMs);
}

// It waits for nothing any more.
void Engine::AwaitDeath(Task& task) {
  LeaveWait(task);
  EnterWait(task, {awaited::Nothing{}});
  Refresh(*task.process->robot);
}

}  // namespace tcs
