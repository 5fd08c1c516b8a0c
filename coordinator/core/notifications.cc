// What clients say. Everything in a notification is untrusted: it is a copy, and it is checked.
#include <sched.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

namespace {

constexpr int kRealTimeBand = 100;  // what asks for SCHED_FIFO or SCHED_RR precedes all others

std::string Printable(const char* text, std::size_t size) {
  std::string printable(text, strnlen(text, size));
  for (char& c : printable) c = c >= ' ' && c < 127 ? c : '?';
  return printable;
}

}  // namespace

void Engine::EndWatches(Task& task) {
  for (const int fd : task.watched) {
    // The client shares the open file, so closing alone would leave it in the epoll set.
    epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr);
    close(fd);
  }
  task.watched.clear();
}

void Engine::WaitForFds(Task& task, const shm::Notification& note) {
  SetState(task, TaskState::kWaiting);
  task.waits_for_fds = true;
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

void Engine::WaitForChild(Task& task) {
  SetState(task, TaskState::kWaiting);
  task.waits_for_child = true;
  ++waiting_for_child_;
  task.deadline_ns = shm::kNeverNs;
  for (const Process& child : processes_) {
    // A child that ended before the parent came to wait.
    if (child.dead && child.parent == task.process->pid && !child.is_client &&
        ThreadState(child.pid) == 'Z') {
      MakeReady(task, shm::WakeReason::kGo);
      return;
    }
  }
}

void Engine::NoteSpawned(Task& task, pid_t pid) {
  if (pid == 0) {
    for (const pid_t tid : ThreadsOf(task.process->pid)) {
      if (KnownTask(tid) != nullptr) continue;
      SetLevel(tid, Level::kWaiting);
      AddThread(*task.process, tid);
    }
    return;
  }
  for (const Process& known : processes_) {
    if (known.pid == pid && !known.dead) return;
  }
  if (ThreadState(pid) == 'X' || ThreadState(pid) == 'Z') return;
  SetLevel(pid, Level::kWaiting);
  NewTask(pid, task.process->pid, task.cpu, task.process->name, task.priority);
}

void Engine::Handle(Task& task, const shm::Notification& note) {
  using Kind = shm::NotificationKind;
  VirtualCpu& cpu = *task.cpu;
  event_ns_ = cpu.progress_ns;
  task.reason = shm::WakeReason::kGo;
  // From the program's clock to the virtual CPU's.
  task.deadline_ns = shm::kNeverNs;
  if (note.deadline_ns != shm::kNeverNs) {
    task.deadline_ns = std::max(note.deadline_ns - task.process->frozen_ns, cpu.progress_ns);
  }
  switch (note.kind) {
    case Kind::kRead:
    case Kind::kWrite:
      SetState(task, TaskState::kHolding);
      task.hold = note.kind;
      break;
    case Kind::kIdle:
      SetState(task, TaskState::kWaiting);
      task.has_wait_mask = note.args[0] == 1;
      task.wait_mask = static_cast<std::uint64_t>(note.args[1]);
      break;
    case Kind::kWaitFds:
      WaitForFds(task, note);
      Refresh(cpu);
      // What is there already ends the wait here and now.
      PollEvents(0);
      break;
    case Kind::kWaitChild:
      WaitForChild(task);
      break;
    case Kind::kTimerCreate:
    case Kind::kTimerSet:
    case Kind::kTimerGet:
    case Kind::kTimerDelete:
      SetTimer(task, note);
      break;
    case Kind::kSpawned:
      NoteSpawned(task, static_cast<pid_t>(note.args[0]));
      break;
    case Kind::kYield:
      cpu.ready.Rotate(task.order);
      break;
    case Kind::kPriority: {
      const auto policy = static_cast<std::int32_t>(note.args[0]);
      const bool real_time = policy == SCHED_FIFO || policy == SCHED_RR;
      Slot(task).policy = policy;
      Slot(task).priority = static_cast<std::int32_t>(note.args[1]);
      task.priority =
          real_time
              ? kRealTimeBand + static_cast<int>(std::clamp<std::int64_t>(note.args[1], 1, 99))
              : task.process->priority;
      cpu.ready.SetPriority(task.order, task.priority);
      break;
    }
    case Kind::kUncovered:
      Warn(task.process->name + " uses " + Printable(note.text, sizeof note.text) +
           ", which does not live in virtual time yet: its waits take real time");
      break;
    case Kind::kSignalled:
      WakeSignalled(static_cast<pid_t>(note.args[0]));
      break;
    case Kind::kThreadExit:
      task.process->ended_cpu_ns += task.charged_ns;
      Slot(task).gate.store(shm::kGateOpen);
      EndTask(task);
      WakeJoiners(task);
      break;
    case Kind::kNone:
    case Kind::kHorizon:
    case Kind::kInterrupted:
    case Kind::kResumed:
      break;
  }
  Refresh(cpu);
}

}  // namespace tcs
