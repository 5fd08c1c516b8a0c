// The timers of clients: setitimer, alarm and timerfd. What runs out at one instant fires there.
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

std::int64_t Engine::ChargedTo(const Process& process) const {
  std::int64_t charged = process.ended_cpu_ns;
  for (const Task* task : process.robot->tasks) {
    if (task->process == &process) charged += task->charged_ns;
  }
  return charged;
}

void Engine::FindNextExpiry(Process& process) {
  process.next_expiry_ns = shm::kNeverNs;
  for (const auto& [id, timer] : process.timers) {
    if (timer.next_ns != 0)
      process.next_expiry_ns = std::min(process.next_expiry_ns, timer.next_ns);
  }
}

std::int64_t Engine::NextCpuExpiry(const Process& process) const {
  std::int64_t next = shm::kNeverNs;
  for (const Timer& timer : process.cpu_timers) {
    if (timer.next_ns != 0) next = std::min(next, timer.next_ns);
  }
  return next;
}

void Engine::SetTimer(Task& task, const shm::Notification& note) {
  Process& process = *task.process;
  const std::int64_t id = note.args[0];
  if (note.kind == shm::NotificationKind::kTimerCreate) {
    const int fd = DuplicateFd(process.pidfd, static_cast<int>(id));
    if (fd < 0) return;
    const std::int64_t made = process.next_timer_id++;
    process.timers[made] = Timer{0, 0, fd};
    task.reply[0] = made;
    return;
  }
  if (note.kind == shm::NotificationKind::kTimerDelete) {
    const auto found = process.timers.find(id);
    if (found == process.timers.end()) return;
    if (found->second.event_fd >= 0) close(found->second.event_fd);
    process.timers.erase(found);
    FindNextExpiry(process);
    return;
  }
  const bool on_cpu_time = id == ITIMER_VIRTUAL || id == ITIMER_PROF;
  if (!on_cpu_time && id != ITIMER_REAL && !process.timers.contains(id)) return;
  Timer& timer = on_cpu_time ? process.cpu_timers[id - ITIMER_VIRTUAL] : process.timers[id];
  task.reply[0] = timer.next_ns;
  task.reply[1] = timer.interval_ns;
  if (note.kind != shm::NotificationKind::kTimerSet) return;
  timer.next_ns = std::max<std::int64_t>(0, note.args[1]);
  timer.interval_ns = std::max<std::int64_t>(0, note.args[2]);
  FindNextExpiry(process);
  if (timer.event_fd >= 0) {
    // Setting a timer forgets expirations that were not read; emptying must not wait.
    eventfd_t unread;
    const std::uint64_t one = 1;
    if (write(timer.event_fd, &one, sizeof one) == sizeof one)
      eventfd_read(timer.event_fd, &unread);
  }
}

// Fires what has run out for one process; true if a descriptor was written to.
bool Engine::Expire(Process& process, std::int64_t now_ns) {
  const std::int64_t now = now_ns + process.frozen_ns;
  bool wrote = false;
  for (auto& [id, timer] : process.timers) {
    if (timer.next_ns == 0 || timer.next_ns > now) continue;
    std::uint64_t count = 1;
    if (timer.interval_ns > 0) {
      count += static_cast<std::uint64_t>((now - timer.next_ns) / timer.interval_ns);
      timer.next_ns += static_cast<std::int64_t>(count) * timer.interval_ns;
      const bool awaited = std::any_of(
          process.robot->tasks.begin(), process.robot->tasks.end(), [&](const Task* task) {
            return task->process == &process &&
                   (task->state == TaskState::kWaiting || task->state == TaskState::kUnseen);
          });
      process.overruns += static_cast<std::int64_t>(count) - (awaited ? 1 : 0);
    } else {
      timer.next_ns = 0;
    }
    if (timer.event_fd >= 0) {
      wrote |= write(timer.event_fd, &count, sizeof count) == sizeof count;
    } else {
      process.pending_signals.push_back(SIGALRM);
    }
  }
  FindNextExpiry(process);
  return wrote;
}

// The two timers on processor time run out while their process runs; it is told at its next
// dispatch.
void Engine::ExpireCpuTimers(Process& process) {
  if (NextCpuExpiry(process) == shm::kNeverNs) return;
  const std::int64_t charged = ChargedTo(process);
  for (const int which : {ITIMER_VIRTUAL, ITIMER_PROF}) {
    Timer& timer = process.cpu_timers[which - ITIMER_VIRTUAL];
    if (timer.next_ns == 0 || timer.next_ns > charged) continue;
    if (timer.interval_ns > 0) {
      timer.next_ns += ((charged - timer.next_ns) / timer.interval_ns + 1) * timer.interval_ns;
    } else {
      timer.next_ns = 0;
    }
    process.pending_signals.push_back(which == ITIMER_VIRTUAL ? SIGVTALRM : SIGPROF);
  }
}

// A thread that waits, and is to run a handler, is dispatched first: the handler is its work.
// Otherwise the signal goes at once: it stays pending, is ignored, ends the process, or ends what
// the kernel holds the thread in. One that is ready gets it at its dispatch.
void Engine::SendTimerSignals(Task& task) {
  Process& process = *task.process;
  if (task.state != TaskState::kWaiting && task.state != TaskState::kUnseen) return;
  const SignalSets sets = ReadSignalSets(task.tid);
  const std::uint64_t blocked = task.has_wait_mask ? task.wait_mask : sets.blocked;
  const auto is_handled = [&](int signal) {
    return (sets.caught & ~blocked & (std::uint64_t{1} << (signal - 1))) != 0;
  };
  const bool handled =
      std::any_of(process.pending_signals.begin(), process.pending_signals.end(), is_handled);
  if (task.state == TaskState::kWaiting && handled) {
    MakeReady(task, shm::WakeReason::kSignal);
    return;
  }
  for (const int signal : process.pending_signals) kill(process.pid, signal);
  process.pending_signals.clear();
}

void Engine::FireDue(Robot& robot, std::int64_t now_ns) {
  event_ns_ = now_ns;
  bool wrote = false;
  for (Task* task : robot.tasks) {
    if (task->state == TaskState::kWaiting && task->deadline_ns <= now_ns) {
      MakeReady(*task, shm::WakeReason::kDeadline);
    }
    Process& process = *task->process;
    if (process.next_expiry_ns - process.frozen_ns <= now_ns) wrote |= Expire(process, now_ns);
    if (!process.pending_signals.empty()) SendTimerSignals(*task);
  }
  if (wrote) PollEvents(0);
}

}  // namespace tcs
