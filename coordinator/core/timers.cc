// The timers of clients: setitimer, alarm, timerfd and timer_create. What runs out at one instant
// fires there.
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstring>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/timer_descriptor.h"

namespace tcs {

namespace {

using shm::TimerClock;

constexpr std::int64_t kLeastCpuNs = 1'000;
// Of one process. Natively its limits (RLIMIT_SIGPENDING, RLIMIT_NOFILE) are about the same.
constexpr std::size_t kMostTimers = 16'384;

// How often it has run out by `now`, on its clock; sets it to the next time.
std::int64_t TakeExpirations(Timer& timer, std::int64_t now) {
  if (timer.next_ns == 0 || timer.next_ns > now) return 0;
  if (timer.interval_ns == 0) {
    timer.next_ns = 0;
    return 1;
  }
  const std::int64_t count = 1 + (now - timer.next_ns) / timer.interval_ns;
  const std::int64_t last_ns = timer.next_ns + (count - 1) * timer.interval_ns;
  const bool ends = last_ns > shm::kNeverNs - timer.interval_ns;  // after the end of all time
  timer.next_ns = ends ? shm::kNeverNs : last_ns + timer.interval_ns;
  return count;
}

shm::TimerKind KindOfItimer(std::int64_t which) {
  shm::TimerKind kind;
  kind.signal = which == ITIMER_REAL ? SIGALRM : which == ITIMER_VIRTUAL ? SIGVTALRM : SIGPROF;
  kind.clock = which == ITIMER_REAL ? TimerClock::kTime : TimerClock::kProcessCpu;
  return kind;
}

}  // namespace

void Engine::FindNextExpiry(Process& process) {
  process.next_expiry_ns = shm::kNeverNs;
  process.has_cpu_timers = false;
  for (const auto& [id, timer] : process.timers) {
    if (timer.next_ns == 0) continue;
    if (timer.kind.clock == TimerClock::kTime) {
      if (timer.rests) continue;
      process.next_expiry_ns = std::min(process.next_expiry_ns, timer.next_ns - timer.frozen_ns);
    } else {
      process.has_cpu_timers = true;
    }
  }
}

// The processor time that the thread may still use before a timer on such time runs out.
std::int64_t Engine::CpuTimeToExpiry(const Task& task) const {
  const Process& process = *task.process;
  std::int64_t left = shm::kNeverNs;
  if (!process.has_cpu_timers) return left;
  for (const auto& [id, timer] : process.timers) {
    if (timer.next_ns == 0) continue;
    if (timer.kind.clock == TimerClock::kProcessCpu) {
      left = std::min(left, CpuTimeLeft(timer, ChargedTo(process)));
    } else if (timer.kind.clock == TimerClock::kThreadCpu && timer.kind.clock_tid == task.tid) {
      left = std::min(left, CpuTimeLeft(timer, task.charged_ns));
    }
  }
  // What has run out already is found when it has run.
  return std::max(kLeastCpuNs, left);
}

bool Engine::IsFull(const Process& process) { return process.timers.size() >= kMostTimers; }

// Our copy of a process's descriptor; -1 if that is no timer.
int Engine::TimerDescriptorOf(const Process& process, int number) {
  const int fd = DuplicateFd(process.pidfd, number);
  if (fd < 0 || IsTimerDescriptor(fd)) return fd;
  close(fd);
  return -1;
}

void Engine::CreateTimer(Task& task, const shm::Notification& note) {
  Process& process = *task.process;
  if (IsFull(process)) return;
  Timer timer;
  static_assert(sizeof timer.kind == sizeof note.args - sizeof note.args[0]);
  memcpy(static_cast<void*>(&timer.kind), &note.args[1], sizeof timer.kind);
  if (timer.kind.signal < 0 || timer.kind.signal > SIGRTMAX) return;
  if (note.args[0] >= 0) {
    timer.fd = TimerDescriptorOf(process, static_cast<int>(note.args[0]));
    if (timer.fd < 0) return;
  }
  task.reply[0] = process.next_timer_id++;
  process.timers[task.reply[0]] = timer;
}

void Engine::DeleteTimer(Process& process, std::int64_t id) {
  const auto found = process.timers.find(id);
  if (found == process.timers.end()) return;
  if (found->second.fd >= 0) close(found->second.fd);
  process.timers.erase(found);
  std::erase_if(process.timer_signals, [&](const TimerSignal& s) { return s.timer_id == id; });
  FindNextExpiry(process);
}

// A process's timer_create timers end when it executes another program.
void Engine::DeletePosixTimers(Process& process) {
  std::vector<std::int64_t> ended;
  for (const auto& [id, timer] : process.timers) {
    if (timer.kind.is_posix != 0) ended.push_back(id);
  }
  for (const std::int64_t id : ended) DeleteTimer(process, id);
}

void Engine::SetTimer(Task& task, const shm::Notification& note) {
  SetTimerOf(*task.process, task, note);
}

// The three of setitimer are there without being created.
void Engine::EnsureItimer(Process& process, std::int64_t id) {
  if (id >= ITIMER_REAL && id <= ITIMER_PROF && !process.timers.contains(id)) {
    process.timers[id].kind = KindOfItimer(id);
  }
}

// A timer of `process`, by one of its threads, or of its children, which have its descriptors.
void Engine::SetTimerOf(Process& process, Task& task, const shm::Notification& note) {
  const std::int64_t id = note.args[0];
  if (note.kind == shm::NotificationKind::kTimerCreate) return CreateTimer(task, note);
  if (note.kind == shm::NotificationKind::kTimerDelete) return DeleteTimer(process, id);
  EnsureItimer(process, id);
  const auto found = process.timers.find(id);
  if (found == process.timers.end()) return;
  Timer& timer = found->second;
  const bool accepts = note.kind == shm::NotificationKind::kTimerOverrun && note.args[1] != 0;
  if (!accepts) BringUpToDate(process, task, id);
  if (note.kind == shm::NotificationKind::kTimerOverrun) {
    if (accepts && timer.queued) {
      // What has run out by now is the accepted signal's.
      if (timer.kind.clock == TimerClock::kTime) {
        timer.overruns += TakeExpirations(timer, task.reached_ns + timer.frozen_ns);
        timer.overruns = std::min<std::int64_t>(INT_MAX, timer.overruns);
      }
      timer.Accept();
      FindNextExpiry(process);
    }
    NoteAccepted(process);
    task.reply[0] = timer.last_overruns;
    return;
  }
  task.reply[0] = timer.next_ns;
  task.reply[1] = timer.interval_ns;
  if (note.kind != shm::NotificationKind::kTimerSet) return;
  timer.next_ns = std::max<std::int64_t>(0, note.args[1]);
  timer.interval_ns = std::max<std::int64_t>(0, note.args[2]);
  timer.frozen_ns = process.frozen_ns;
  timer.queued = timer.rests = false;
  timer.overruns = timer.last_overruns = 0;
  FindNextExpiry(process);
  if (timer.fd >= 0) ForgetExpirations(timer.fd);
}

// POSIX: one signal of a timer is on its way at a time; what runs out meanwhile is its overruns.
void Engine::SignalExpiry(Process& process, std::int64_t id, Timer& timer, std::int64_t count) {
  if (timer.kind.is_posix == 0) {
    // Such signals are not counted.
    const bool is_underway = std::any_of(
        process.timer_signals.begin(), process.timer_signals.end(),
        [&](const TimerSignal& s) { return s.timer_id == 0 && s.number == timer.kind.signal; });
    if (is_underway) return;
    process.timer_signals.push_back({.number = timer.kind.signal});
    return;
  }
  if (timer.queued) {
    timer.overruns = std::min<std::int64_t>(INT_MAX, timer.overruns + count);
    return;
  }
  timer.queued = true;
  timer.overruns = std::min<std::int64_t>(INT_MAX, count - 1);
  process.timer_signals.push_back({.number = timer.kind.signal,
                                   .tid = timer.kind.signal_tid,
                                   .timer_id = id,
                                   .value = timer.kind.value,
                                   .overruns = timer.overruns});
}

// Fires what has run out for one process; true if a descriptor was written to.
bool Engine::Expire(Process& process, std::int64_t now_ns) {
  bool wrote = false;
  NoteAccepted(process);
  for (auto& [id, timer] : process.timers) {
    if (timer.kind.clock != TimerClock::kTime) continue;
    const std::int64_t now = now_ns + timer.frozen_ns;
    const std::int64_t count = TakeExpirations(timer, now);
    if (count == 0) continue;
    process.shown_ns = std::max(process.shown_ns, now);
    if (IsShort(timer)) Rest(process, timer, now);
    if (timer.interval_ns > 0) {
      const bool awaited = std::any_of(
          process.robot->tasks.begin(), process.robot->tasks.end(), [&](const Task* task) {
            return task->process == &process &&
                   (task->state == TaskState::kWaiting || task->state == TaskState::kUnseen);
          });
      process.ended.CountOverruns(count - (awaited ? 1 : 0));
    }
    if (timer.fd >= 0) wrote |= AddExpirations(timer.fd, count);
    if (timer.kind.signal != 0) SignalExpiry(process, id, timer, count);
  }
  FindNextExpiry(process);
  return wrote;
}

// Timers on processor time run out while their process runs; it is told at its next dispatch.
void Engine::ExpireCpuTimers(const Task& ran) {
  Process& process = *ran.process;
  if (!process.has_cpu_timers) return;
  NoteAccepted(process);
  for (auto& [id, timer] : process.timers) {
    if (timer.kind.clock == TimerClock::kTime) continue;
    if (timer.kind.clock == TimerClock::kThreadCpu && timer.kind.clock_tid != ran.tid) continue;
    const std::int64_t now =
        timer.kind.clock == TimerClock::kThreadCpu ? ran.charged_ns : ChargedTo(process);
    const std::int64_t count = TakeExpirations(timer, now);
    if (count == 0) continue;
    timer.seen_ns = now;
    if (timer.fd >= 0) AddExpirations(timer.fd, count);
    if (timer.kind.signal != 0) SignalExpiry(process, id, timer, count);
  }
  FindNextExpiry(process);
}

void Engine::FireDue(Robot& robot, std::int64_t now_ns) {
  const Moment moment{.ns = now_ns, .from_outside = true};
  latest_ns_ = now_ns;
  bool wrote = false;
  for (Task* task : robot.tasks) {
    if (task->state == TaskState::kWaiting && HasRunOut(*task, now_ns)) {
      Process& woken = *task->process;
      woken.shown_ns = std::max(woken.shown_ns, task->deadline_ns + task->frozen_ns);
      MakeReady(*task, shm::WakeReason::kDeadline, moment);
    }
    Process& process = *task->process;
    if (process.next_expiry_ns <= now_ns) {
      process.expired_ns = process.next_expiry_ns;
      wrote |= Expire(process, now_ns);
    }
    if (!process.timer_signals.empty()) RouteTimerSignals(process, moment);
  }
  if (wrote) PollEvents(0, moment);
}

}  // namespace tcs
