#include "coordinator/calls/timer_calls.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "coordinator/os/open_files.h"
#include "coordinator/os/own_number.h"
#include "coordinator/os/timer_descriptor.h"
#include "coordinator/processes/usage_book.h"
#include "coordinator/tasks/remote_descriptor.h"

namespace tcs {

namespace {

// True if a descriptor was written to.
bool TellDescriptors(const Process& process, const std::vector<ProcessTimers::RanOut>& ran_out) {
  bool wrote = false;
  for (const ProcessTimers::RanOut& timer : ran_out) {
    const auto fd = process.timer_fds.find(timer.id);
    if (fd != process.timer_fds.end()) wrote |= AddExpirations(fd->second.get(), timer.count);
  }
  return wrote;
}

// A thread of the process's is in a call on the timer's descriptor.
bool IsInCall(const Process& process, std::int64_t id) {
  const auto timer = process.timer_fds.find(id);
  if (process.threads == 1 || timer == process.timer_fds.end()) return false;
  const auto has_timer = [&](const std::vector<UniqueFd>& files) {
    return std::ranges::any_of(
        files, [&](const UniqueFd& file) { return IsSameFile(file.get(), timer->second.get()); });
  };
  return std::ranges::any_of(process.robot->tasks, [&](const Task* task) {
    if (task->process != &process) return false;
    const auto* wait = task->Awaits<awaited::Descriptors>();
    return (wait != nullptr && has_timer(wait->fds)) ||
           (task->kept.has_value() && has_timer(task->kept->files));
  });
}

bool IsAwaited(const Process& process) {
  return std::ranges::any_of(process.robot->tasks, [&](const Task* task) {
    return task->process == &process &&
           (task->state == TaskState::kWaiting || task->state == TaskState::kUnseen);
  });
}

}  // namespace

UniqueFd TimerCalls::DescriptorOf(const Process& process, int number) {
  UniqueFd fd = CopyOfDescriptor(process, number);
  return fd && IsTimerDescriptor(fd.get()) ? std::move(fd) : UniqueFd();
}

pid_t TimerCalls::ThreadNamed(const Process& process, pid_t said) {
  return process.pid_namespace == 0 ? said : ThreadByOwnNumber(process.pid, said);
}

void TimerCalls::Create(Task& task, const shm::Notification& note) {
  Process& process = *task.process;
  if (process.timers.IsFull()) return;
  shm::TimerKind kind;
  static_assert(sizeof kind == sizeof note.args - sizeof note.args[0]);
  memcpy(static_cast<void*>(&kind), &note.args[1], sizeof kind);
  if (kind.signal < 0 || kind.signal > SIGRTMAX) return;
  if (kind.signal_tid != 0) kind.signal_tid = ThreadNamed(process, kind.signal_tid);
  if (kind.clock == shm::TimerClock::kThreadCpu) {
    kind.clock_tid = ThreadNamed(process, kind.clock_tid);
  }
  UniqueFd fd;
  if (note.args[0] >= 0) {
    fd = DescriptorOf(process, static_cast<int>(note.args[0]));
    if (!fd) return;
  }
  task.reply[0] = process.timers.Create(kind);
  if (fd) process.timer_fds[task.reply[0]] = std::move(fd);
}

void TimerCalls::Delete(Process& process, std::int64_t id) {
  process.timers.Delete(id);
  process.timer_fds.erase(id);
}

// The timer's last descriptor is closed. A call on the descriptor holds the timer for as long as
// the call lasts.
void TimerCalls::Close(Process& process, std::int64_t id) {
  process.closed_timers.push_back(id);
  DeleteClosed(process);
}

void TimerCalls::DeleteClosed(Process& process) {
  std::erase_if(process.closed_timers, [&](std::int64_t id) {
    const bool is_held = IsInCall(process, id);
    if (!is_held) Delete(process, id);
    return !is_held;
  });
}

void TimerCalls::DeletePosix(Process& process) {
  process.timers.DeletePosix();
  std::erase_if(process.timer_fds,
                [&](const auto& entry) { return !process.timers.KindOf(entry.first).has_value(); });
}

bool TimerCalls::Handle(Process& process, Task& task, const shm::Notification& note) {
  const std::int64_t id = note.args[0];
  ProcessTimers& timers = process.timers;
  if (note.kind == shm::NotificationKind::kTimerCreate) {
    Create(task, note);
    return false;
  }
  if (note.kind == shm::NotificationKind::kTimerDelete) {
    Close(process, id);
    return false;
  }
  if (!timers.KindOf(id).has_value()) return false;
  if (note.kind == shm::NotificationKind::kTimerOverrun) {
    bool wrote = false;
    if (note.args[1] == 0) {
      wrote = BringUpToDate(process, task, id);
    } else {
      timers.AcceptAt(id, task.reached, TimerSignals::IsPending(process, id));
    }
    task.reply[0] = OverrunsAt(process, id, task.reached);
    return wrote;
  }
  const bool wrote = BringUpToDate(process, task, id);
  const ProcessTimers::Setting before = timers.Get(id);
  task.reply[0] = before.next_ns;
  task.reply[1] = before.interval_ns;
  if (note.kind != shm::NotificationKind::kTimerSet) return wrote;
  timers.Set(id, {note.args[1], note.args[2], note.args[3] != 0}, process.clock.lead());
  const auto fd = process.timer_fds.find(id);
  if (fd != process.timer_fds.end()) ForgetExpirations(fd->second.get());
  return wrote;
}

std::int64_t TimerCalls::OverrunsAt(Process& process, std::int64_t id, VirtualTime now) const {
  signals_.NoteAccepted(process, now);
  return process.timers.Overruns(id);
}

// Expirations by the time of the call are there when the call returns.
bool TimerCalls::BringUpToDate(Process& owner, const Task& asking, std::int64_t id) {
  if (!owner.timers.IsBehind(id, asking.reached)) return false;
  const EventTime when{asking.reached};
  const bool wrote = Expire(owner, when.at);
  if (owner.timers.HasSignals()) signals_.Route(owner, when);
  return wrote;
}

// Fires the timers of one process that have run out; true if a descriptor was written to.
bool TimerCalls::Expire(Process& process, VirtualTime now) {
  signals_.NoteAccepted(process, now);
  const std::vector<ProcessTimers::RanOut> ran_out = process.timers.Expire(now);
  for (const ProcessTimers::RanOut& timer : ran_out) {
    process.clock.ComeTo(*timer.shown);
    if (timer.is_periodic) process.ended.CountOverruns(timer.count - (IsAwaited(process) ? 1 : 0));
  }
  return TellDescriptors(process, ran_out);
}

ProcessTimers::CpuUsed TimerCalls::CpuUsedBy(const Task& task) {
  return {.process = UsageBook::ChargedTo(*task.process), .tid = task.tid, .thread = task.charged};
}

void TimerCalls::ExpireCpu(const Task& ran) {
  Process& process = *ran.process;
  if (!process.timers.HasCpuTimers()) return;
  signals_.NoteAccepted(process, ran.reached);
  TellDescriptors(process, process.timers.ExpireCpu(CpuUsedBy(ran)));
  process.robot->keeps_timer_signals |= process.timers.HasSignals();
}

bool TimerCalls::FireDue(Robot& robot, VirtualTime now) {
  const EventTime when{.at = now, .from_outside = true};
  run_.latest = now;
  bool wrote = false;
  // Of most steps that is all: to look at each thread would cost more than the rest of the step.
  if (!std::exchange(robot.keeps_timer_signals, false) && !robot.scheduler.IsAnythingDue(now))
    return wrote;
  for (Task* task : robot.tasks) {
    if (waker_.HasRunOut(*task, now)) {
      task->process->clock.ComeTo(Waker::OwnDeadlineOf(*task));
      waker_.Wake(*task, shm::WakeReason::kDeadline, when);
    }
    Process& process = *task->process;
    if (process.timers.NextExpiry() <= now) {
      if (!process.closed_timers.empty()) DeleteClosed(process);
      process.expired = process.timers.NextExpiry();
      wrote |= Expire(process, now);
    }
    if (process.timers.HasSignals()) signals_.Route(process, when);
  }
  return wrote;
}

}  // namespace tcs
