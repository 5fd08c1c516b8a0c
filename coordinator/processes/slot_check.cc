#include "coordinator/processes/slot_check.h"

#include <signal.h>

#include <algorithm>
#include <cstring>

#include "coordinator/tasks/run_state.h"
#include "shm/clock_page.h"

namespace tcs {

namespace {

// More than what clocks and the coordinator's estimates differ by in one dispatch.
constexpr std::int64_t kSlackNs = 10'000'000;
// More than all ways out of gates in one dispatch take, and than the TSC can miss.
constexpr std::int64_t kLargeSlackNs = 1'000'000'000;

// Whether so much time can have passed on that robot, in a run that has taken so long.
bool CanHavePassed(std::int64_t ns, std::int64_t run_ns, const Robot& robot) {
  return static_cast<double>(ns) <= static_cast<double>(run_ns + kLargeSlackNs) / robot.speed;
}

bool CanBeStolen(std::int64_t stolen_ns, std::int64_t run_ns, const Robot& robot) {
  return stolen_ns >= 0 && CanHavePassed(stolen_ns, run_ns, robot);
}

}  // namespace

const char* SlotCheck::WhatIsImpossible(const Task& task, const shm::ClockPage& page) const {
  if (!task.IsOwn(page)) return "the clock that it was given";
  const ClockGrant& grant = task.grant;
  const std::int64_t moved = task.metered.OriginMovedOn(page);
  if (moved < 0 || moved > kLargeSlackNs) return "its processor clock";
  const std::int64_t added = shm::AdjustValue(page.executed_adjust.load());
  const std::int64_t waited = shm::AdjustValue(page.waited_adjust.load());
  if (is_fixed_ && added < -kSlackNs) return "a clock that went back";
  // A thread that ran on while something stopped the coordinator (a tracer) has its CPU clock's
  // time.
  const bool went_ahead = !is_fixed_ && !CanHavePassed(added, run_ns_(), *task.process->robot);
  if (went_ahead) return "a clock that went ahead";
  const std::int64_t idle = std::max<std::int64_t>(0, grant.most_idle_ns - grant.base_time_ns);
  if (waited < 0 || waited > idle + kSlackNs) return "a sleep beyond what it was allowed";
  if (page.last_shown_ns.load() > grant.most_shown_ns) return "a time beyond what it was given";
  const std::int64_t stale = page.staleness_ns.load();
  if (stale < 0 || stale > grant.most_stale_ns) return "data older than any can be";
  if (!CanBeStolen(page.stolen_ns.load(), run_ns_(), *task.process->robot)) {
    return "more stolen than there was";
  }
  return nullptr;
}

const char* SlotCheck::WhatIsImpossible(const shm::Notification& note) {
  using Kind = shm::NotificationKind;
  const auto kind = static_cast<std::uint32_t>(note.kind);
  const bool is_known = kind >= static_cast<std::uint32_t>(Kind::kHorizon) &&
                        kind <= static_cast<std::uint32_t>(Kind::kSetDate) && kind != 16 &&
                        note.kind != Kind::kResumed;
  if (!is_known) return "a notification of no kind";
  if (note.fd_count > shm::kMaxWaitFds) return "a wait for too many descriptors";
  if (note.kind != Kind::kTimerCreate) return nullptr;
  shm::TimerKind timer;
  memcpy(static_cast<void*>(&timer), &note.args[1], sizeof timer);
  const bool is_timer = timer.clock <= shm::TimerClock::kThreadCpu && timer.is_posix <= 1 &&
                        timer.signal >= 0 && timer.signal <= SIGRTMAX;
  return is_timer ? nullptr : "a timer of no kind";
}

std::int64_t SlotCheck::StolenOf(const Task& task) const {
  const std::int64_t stolen = SlotOf(task).clock.stolen_ns.load();
  return CanBeStolen(stolen, run_ns_(), *task.process->robot) ? stolen : 0;
}

std::int64_t SlotCheck::StalenessOf(const Task& task) {
  const std::int64_t stale = SlotOf(task).clock.staleness_ns.load();
  return stale >= 0 && stale <= task.grant.most_stale_ns ? stale : 0;
}

}  // namespace tcs
