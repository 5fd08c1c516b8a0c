// What clients say. Everything in a notification is untrusted: it is a copy, and it is checked.
#include <sys/epoll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

namespace {

bool IsTerminal(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 && S_ISCHR(status.st_mode) && isatty(fd) != 0;
}

// Sleeps, with a mask of their own or without, and waits for signals.
Wait::What IdleFor(const shm::Notification& note) {
  const auto set = static_cast<std::uint64_t>(note.args[1]);
  if (note.args[0] == 2 && set != 0) return awaited::Signals{set};
  return note.args[0] == 1 ? awaited::Time{.mask = set} : awaited::Time{};
}

}  // namespace

// The client shares the open file, so closing our descriptor leaves it in the epoll set until the
// client closes it, too. That is what we want: the next wait for it, under the same number of ours,
// only has to arm it again. What fires meanwhile is of a wait that is over (Tag::kAwaited). But a
// client's epoll set with a signalfd in it must not be polled by us when its wait is over: we have
// other signals, and it would forget that there is one.
void Engine::EndWatches(const awaited::Descriptors& watched) {
  const bool forgets = watched.has_terminal || watched.signals != 0 || watched.is_edge_armed;
  if (!forgets) return;
  for (const UniqueFd& fd : watched.fds) reactor_.Remove(fd.get());
}

Subject Engine::SubjectOfWait(const Task& task, const awaited::Descriptors& watched) {
  return {Tag::kAwaited, static_cast<std::uint32_t>(task.order),
          watched.number & Subject::kNumberMask};
}

awaited::Descriptors Engine::Watch(const Task& task, const shm::WaitFd* fds, std::size_t count) {
  awaited::Descriptors watched{.number = ++wait_counter_, .order = task.fds_order};
  const Subject subject = SubjectOfWait(task, watched);
  for (std::size_t i = 0; i < count; ++i) {
    UniqueFd fd(DuplicateFd(task.process->pidfd.get(), fds[i].fd));
    if (!fd) continue;
    const std::uint32_t events = fds[i].events | EPOLLONESHOT;
    if (!reactor_.Modify(fd.get(), events, subject)) {
      if (!reactor_.Add(fd.get(), events, subject)) continue;
      // Terminals are never left in the set, so they always come this way.
      watched.has_terminal |= IsTerminal(fd.get());
    }
    watched.fds.push_back(std::move(fd));
  }
  return watched;
}

// The wait is a new one, behind all others that want to take from the same descriptor.
void Engine::GoBehind(Task& task, awaited::Descriptors& watched) {
  watched.order = task.fds_order = ++fds_order_counter_;
}

// What the notification asks for: whether one event is for one waiter, and whether signals end it.
awaited::Descriptors Engine::WatchAsAsked(Task& task, const shm::Notification& note) {
  awaited::Descriptors watched = Watch(task, note.fds, note.fd_count);
  watched.signals = static_cast<std::uint64_t>(note.args[1]);
  watched.takes =
      note.args[0] != 0 && watched.fds.size() == 1 && note.fd_count == 1 && watched.signals == 0;
  watched.last_is_first = note.args[0] == 2;
  if (watched.takes) watched.events = note.fds[0].events;
  if (note.args[2] == 0) GoBehind(task, watched);
  return watched;
}

// From the program's clock to the robot's.
std::int64_t Engine::WaitDeadlineOf(const Task& task, const shm::Notification& note) {
  if (note.deadline_ns == shm::kNeverNs) return shm::kNeverNs;
  const ProgramTime deadline = OwnTime(std::max<std::int64_t>(0, note.deadline_ns));
  return std::max(task.process->clock.RobotTimeOf(deadline).ns(), task.reached_ns);
}

void Engine::NoteSpawnedThread(Task& creator, const shm::Notification& note) {
  for (const pid_t tid : ThreadsOf(creator.process->pid)) {
    if (KnownTask(tid) != nullptr || lowered_.contains(tid)) continue;
    executor_->Hold(tid);
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
  executor_->Hold(pid);
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
  const std::int64_t deadline_ns = WaitDeadlineOf(task, note);
  switch (note.kind) {
    case Kind::kRead:
    case Kind::kWrite:
      SetState(task, TaskState::kHolding);
      task.hold = note.kind;
      break;
    case Kind::kIdle:
      EnterWait(task, {IdleFor(note), deadline_ns});
      break;
    case Kind::kWaitFds:
      EnterWait(task, {WatchAsAsked(task, note), deadline_ns});
      looks_again = true;
      break;
    case Kind::kWaitChild:
      EnterWait(task, {awaited::Child{static_cast<pid_t>(note.args[0]), note.args[1] != 0}});
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
      WaitAtQueue(task, note, deadline_ns);
      break;
    case Kind::kWakeKey:
      looks_again = note.args[0] == static_cast<std::int64_t>(shm::WaitKey::kTerminals);
      // The kernel would have given those who wait what they wait for, before the waker could take
      // it again. So they go first, where its policy lets them.
      if (WakeQueue(note.args[0], note.args[1], moment) &&
          ParametersOf(task).policy == SCHED_OTHER) {
        SchedulerOf(task).Yield(task.order);
      }
      break;
    case Kind::kDdsJoin:
    case Kind::kDdsSend:
    case Kind::kDdsWait:
    case Kind::kDdsSync:
    case Kind::kDdsRoom:
    case Kind::kDdsSockets:
      HandleDds(task, note, deadline_ns);
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
    case Kind::kCall:
    case Kind::kPreempted:
      break;
  }
  Refresh(robot);
  return looks_again;
}

}  // namespace tcs
