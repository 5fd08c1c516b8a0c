// What clients say. Everything in a notification is untrusted: it is a copy, and it is checked.
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

// The client shares the open file, so closing our descriptor leaves it in the epoll set until the
// client closes it, too. That is what we want: the next wait for it, under the same number of ours,
// only has to arm it again. What fires meanwhile is of a wait that is over (Tag::kAwaited). But a
// client's epoll set with a signalfd in it must not be polled by us when its wait is over: we have
// other signals, and it would forget that there is one.
void Engine::EndWatches(Task& task) {
  const bool forgets = task.watches_terminal || task.awaited_signals != 0;
  for (const int fd : task.watched) {
    if (forgets || task.is_edge_armed) reactor_.Remove(fd);
    close(fd);
  }
  task.watched.clear();
  task.takes = task.last_is_first = task.is_edge_armed = task.skips_event = false;
  task.passed_over_for = nullptr;
  if (task.watches_terminal) header_->key_waiters.store(--key_waiters_);
  task.watches_terminal = false;
}

Subject Engine::SubjectOfWait(const Task& task) {
  return {Tag::kAwaited, static_cast<std::uint32_t>(task.order),
          task.wait_number & Subject::kNumberMask};
}

void Engine::WatchFds(Task& task, const shm::WaitFd* fds, std::size_t count) {
  SetState(task, TaskState::kWaiting);
  task.waits_for_fds = true;
  task.wait_number = ++wait_counter_;
  for (std::size_t i = 0; i < count; ++i) {
    const int fd = DuplicateFd(task.process->pidfd.get(), fds[i].fd);
    if (fd < 0) continue;
    const std::uint32_t events = fds[i].events | EPOLLONESHOT;
    if (reactor_.Modify(fd, events, SubjectOfWait(task))) {
      task.watched.push_back(fd);
    } else if (reactor_.Add(fd, events, SubjectOfWait(task))) {
      task.watched.push_back(fd);
      NoteTerminal(task, fd);  // never left in the set, so it always comes this way
    } else {
      close(fd);
    }
  }
}

void Engine::WaitForChild(Task& task, pid_t which, bool stops) {
  SetState(task, TaskState::kWaiting);
  task.waits_for_child = true;
  task.awaited_child = which;
  ++waiting_for_child_;
  task.awaits_stops = stops;
  waiting_for_stops_ += stops;
  task.deadline_ns = shm::kNeverNs;
}

void Engine::NoteSpawnedThread(Task& creator, const shm::Notification& note) {
  for (const pid_t tid : ThreadsOf(creator.process->pid)) {
    if (KnownTask(tid) != nullptr || lowered_.contains(tid)) continue;
    executor_.Hold(tid);
    Task& thread = *AddThread(*creator.process, tid, creator.reached_ns);
    InheritScheduling(thread, creator);
    if (note.args[1] >= 0) SetPriority(creator, thread, note.args[1], note.args[2]);
    if (note.args[3] != 0) SetAffinity(creator, thread, static_cast<std::uint64_t>(note.args[3]));
  }
}

// Only a child of its own: with CLONE_PARENT its parent's. It has not been waited for, so that its
// number is nobody else's.
void Engine::NoteSpawnedProcess(Task& parent, pid_t pid) {
  Process& of = *parent.process;
  if (pid <= 0 || LivingProcess(pid) != nullptr || KnownTask(pid) != nullptr) return;
  if (ThreadState(pid) == 'X' || ThreadState(pid) == 'Z') return;
  const pid_t actual = ParentOf(pid);
  if (actual != of.pid && (actual != of.parent || actual == getpid())) return;
  executor_.Hold(pid);
  InheritScheduling(*NewChild(pid, of.pid, of, parent.reached_ns), parent);
}

bool Engine::Handle(Task& task, const shm::Notification& note) {
  using Kind = shm::NotificationKind;
  Robot& robot = *task.process->robot;
  const Moment moment{task.reached_ns};
  bool looks_again = false;
  if (task.process->expelled) {
    AwaitDeath(task);
    return false;
  }
  if (const char* what = WhatIsImpossible(note); what != nullptr) {
    Expel(*task.process, what);
    return false;
  }
  task.reason = shm::WakeReason::kGo;
  task.expects_kernel = note.kind == Kind::kKernelWait;
  // From the program's clock to the robot's.
  task.deadline_ns = shm::kNeverNs;
  if (note.deadline_ns != shm::kNeverNs) {
    const std::int64_t deadline_ns = std::max<std::int64_t>(0, note.deadline_ns);
    task.deadline_ns = std::max(deadline_ns - task.process->frozen_ns, task.reached_ns);
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
      if (note.args[0] == 2) AwaitSignals(task, static_cast<std::uint64_t>(note.args[1]));
      break;
    case Kind::kWaitFds:
      WatchFds(task, note.fds, note.fd_count);
      task.takes =
          note.args[0] != 0 && task.watched.size() == 1 && note.fd_count == 1 && note.args[1] == 0;
      task.last_is_first = note.args[0] == 2;
      if (task.takes) task.watched_events = note.fds[0].events;
      if (note.args[2] == 0) task.wait_order = ++wait_order_counter_;
      AwaitSignals(task, static_cast<std::uint64_t>(note.args[1]));
      looks_again = true;
      break;
    case Kind::kWaitChild:
      WaitForChild(task, static_cast<pid_t>(note.args[0]), note.args[1] != 0);
      FindUnknownChildren(*task.process);
      // It has looked, and found none; but since then one may have ended. One that it does not wait
      // for stays there, so a look at who is there would never let it wait.
      if (std::exchange(task.children_looked, task.process->children_changed) !=
          task.process->children_changed) {
        MakeReady(task, shm::WakeReason::kGo, moment);
      }
      break;
    case Kind::kTimerCreate:
    case Kind::kTimerSet:
    case Kind::kTimerGet:
    case Kind::kTimerDelete:
    case Kind::kTimerOverrun:
      looks_again = SetTimerOf(*task.process, task, note);
      break;
    case Kind::kSpawned:
      if (note.args[0] == 0) {
        NoteSpawnedThread(task, note);
      } else {
        NoteSpawnedProcess(task, static_cast<pid_t>(note.args[0]));
      }
      break;
    case Kind::kYield:
      looks_again = Yield(task);
      break;
    case Kind::kPriority:
    case Kind::kPriorityGet:
    case Kind::kAffinity:
      HandleScheduling(task, note);
      break;
    case Kind::kStrangers:
      task.process->has_strangers = true;
      break;
    case Kind::kSignalled:
      WakeSignalled(static_cast<pid_t>(note.args[0]), moment);
      break;
    case Kind::kWaitKey:
      WaitForKey(task, note);
      break;
    case Kind::kWakeKey:
      looks_again = note.args[0] == static_cast<std::int64_t>(shm::WaitKey::kTerminals);
      // The kernel would have given those who wait what they wait for, before the waker could take
      // it again. So they go first, where its policy lets them.
      if (WakeKey(note.args[0], note.args[1], moment) && ParametersOf(task).policy == SCHED_OTHER) {
        SchedulerOf(task).Yield(task.order);
      }
      break;
    case Kind::kDdsJoin:
    case Kind::kDdsSend:
    case Kind::kDdsWait:
    case Kind::kDdsSync:
    case Kind::kDdsRoom:
    case Kind::kDdsSockets:
      HandleDds(task, note);
      break;
    case Kind::kQueueNotifies:
      header_->queues_notify.store(1);
      break;
    case Kind::kNone:
    case Kind::kHorizon:
    case Kind::kInterrupted:
    case Kind::kResumed:
    case Kind::kKernelWait:
    case Kind::kPassOn:  // any stop does it
      break;
  }
  Refresh(robot);
  return looks_again;
}

}  // namespace tcs
