// What clients say. Everything in a notification is untrusted: it is a copy, and it is checked.
#include <sched.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "coordinator/core/engine.h"

namespace tcs {

void Engine::MakeReady(Task& task, shm::WakeReason reason) {
  if (task.state == TaskState::kDead) return;
  const bool reads =
      task.state == TaskState::kWaiting && (task.waits_for_fds || task.waits_for_child);
  if (task.state == TaskState::kWaiting) ++task.activations;
  EndWatches(task);
  task.waits_for_fds = task.waits_for_child = false;
  // Whoever waited for others looks at what they did: that must be all of it.
  task.state = reads ? TaskState::kHolding : TaskState::kReady;
  task.hold = shm::NotificationKind::kRead;
  task.deadline_ns = shm::kNeverNs;
  task.reason = reason;
  task.ready_number = ++ready_counter_;
  VirtualCpu& cpu = *task.cpu;
  bool alone = running_ == nullptr || running_->cpu != &cpu;
  for (const Task* other : cpu.tasks) alone &= other == &task || !IsRunnable(*other);
  if (alone) cpu.progress_ns = std::max(cpu.progress_ns, event_ns_);
}

void Engine::EndWatches(Task& task) {
  for (const int fd : task.watched) {
    // The client shares the open file, so closing alone would leave it in the epoll set.
    epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr);
    close(fd);
  }
  task.watched.clear();
}

void Engine::WaitForFds(Task& task, const shm::Notification& note) {
  task.state = TaskState::kWaiting;
  task.waits_for_fds = true;
  task.deadline_ns = std::max(note.deadline_ns, task.cpu->progress_ns);
  const std::uint32_t count = std::min(note.fd_count, shm::kMaxWaitFds);
  const auto index = static_cast<std::uint32_t>(task.order);
  for (std::uint32_t i = 0; i < count; ++i) {
    const int fd = DuplicateFd(task.process->pidfd, note.fds[i].fd);
    if (fd < 0) continue;
    epoll_event event{};
    event.events = note.fds[i].events | EPOLLONESHOT;
    event.data.u64 = (static_cast<std::uint64_t>(Tag::kAwaited) << 32) | index;
    if (epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) == 0) {
      task.watched.push_back(fd);
    } else {
      close(fd);
    }
  }
}

void Engine::SetTimer(Task& task, const shm::Notification& note) {
  Process& process = *task.process;
  const std::int64_t id = note.args[0];
  switch (note.kind) {
    case shm::NotificationKind::kTimerCreate: {
      const int fd = DuplicateFd(process.pidfd, static_cast<int>(id));
      if (fd < 0) return;
      const std::int64_t made = process.next_timer_id++;
      process.timers[made] = Timer{0, 0, fd};
      task.reply[0] = made;
      return;
    }
    case shm::NotificationKind::kTimerDelete:
      if (const auto found = process.timers.find(id); found != process.timers.end()) {
        if (found->second.event_fd >= 0) close(found->second.event_fd);
        process.timers.erase(found);
      }
      return;
    default:
      break;
  }
  if (id == 1 || id == 2) {
    Warn(process.name + " uses ITIMER_VIRTUAL or ITIMER_PROF, which never fire yet");
    return;
  }
  if (id != 0 && !process.timers.contains(id)) return;
  Timer& timer = process.timers[id];
  task.reply[0] = timer.next_ns;
  task.reply[1] = timer.interval_ns;
  if (note.kind != shm::NotificationKind::kTimerSet) return;
  timer.next_ns = std::max<std::int64_t>(0, note.args[1]);
  timer.interval_ns = std::max<std::int64_t>(0, note.args[2]);
  if (timer.event_fd >= 0) {
    // Setting a timer forgets expirations that were not read; emptying must not wait.
    eventfd_t unread;
    const std::uint64_t one = 1;
    if (write(timer.event_fd, &one, sizeof one) == sizeof one)
      eventfd_read(timer.event_fd, &unread);
  }
}

void Engine::Handle(Task& task, const shm::Notification& note) {
  using Kind = shm::NotificationKind;
  VirtualCpu& cpu = *task.cpu;
  event_ns_ = cpu.progress_ns;
  task.reason = shm::WakeReason::kGo;
  switch (note.kind) {
    case Kind::kRead:
    case Kind::kWrite:
      task.state = TaskState::kHolding;
      task.hold = note.kind;
      return;
    case Kind::kIdle:
      task.state = TaskState::kWaiting;
      task.deadline_ns = std::max(note.deadline_ns, cpu.progress_ns);
      return;
    case Kind::kWaitFds:
      WaitForFds(task, note);
      return;
    case Kind::kWaitChild:
      task.state = TaskState::kWaiting;
      task.waits_for_child = true;
      task.deadline_ns = shm::kNeverNs;
      for (const Process& child : processes_) {
        // A child that ended before the parent came to wait.
        if (child.dead && child.parent == task.process->pid && !child.is_client &&
            ThreadState(child.pid) == 'Z') {
          MakeReady(task, shm::WakeReason::kGo);
          return;
        }
      }
      return;
    case Kind::kTimerCreate:
    case Kind::kTimerSet:
    case Kind::kTimerGet:
    case Kind::kTimerDelete:
      SetTimer(task, note);
      return;
    case Kind::kSpawned: {
      const auto pid = static_cast<pid_t>(note.args[0]);
      for (const Process& known : processes_) {
        if (known.pid == pid && !known.dead) return;
      }
      if (ThreadState(pid) == 'X' || ThreadState(pid) == 'Z') return;
      SetLevel(pid, Level::kWaiting);
      NewTask(pid, task.process->pid, &cpu, task.process->name, task.priority);
      return;
    }
    case Kind::kYield:
      task.ready_number = ++ready_counter_;
      return;
    case Kind::kPriority: {
      const auto policy = static_cast<std::int32_t>(note.args[0]);
      const bool real_time = policy == SCHED_FIFO || policy == SCHED_RR;
      Slot(task).policy = policy;
      Slot(task).priority = static_cast<std::int32_t>(note.args[1]);
      task.priority = real_time
                          ? 100 + static_cast<int>(std::clamp<std::int64_t>(note.args[1], 1, 99))
                          : task.process->priority;
      return;
    }
    case Kind::kUncovered: {
      std::string text(note.text, strnlen(note.text, sizeof note.text));
      for (char& c : text) c = c >= ' ' && c < 127 ? c : '?';
      Warn(task.process->name + " uses " + text +
           ", which does not live in virtual time yet: its waits take real time");
      return;
    }
    case Kind::kThreadExit:
      task.state = TaskState::kDead;
      task.parked = true;
      task.process->ended_cpu_ns += task.charged_ns;
      Slot(task).gate.store(shm::kGateOpen);
      return;
    case Kind::kNone:
    case Kind::kHorizon:
    case Kind::kInterrupted:
    case Kind::kResumed:
      return;
  }
}

}  // namespace tcs
