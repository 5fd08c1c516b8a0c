#include "coordinator/calls/notifications.h"

#include <sys/epoll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "coordinator/calls/signal_reach.h"
#include "coordinator/processes/counter_reads.h"

namespace tcs {

namespace {

constexpr int kYieldsBeforeLook = 100;

// Sleeps, with a mask of their own or without, and waits for signals.
Wait::What IdleFor(const shm::Notification& note) {
  const auto set = static_cast<std::uint64_t>(note.args[1]);
  if (note.args[0] == 2 && set != 0) return awaited::Signals{set};
  return note.args[0] == 1 ? awaited::Time{.mask = set} : awaited::Time{};
}

}  // namespace

// Converts the deadline from the program's clock to the robot's.
VirtualTime Notifications::WaitDeadlineOf(const Task& task, const shm::Notification& note) {
  const ProgramTime deadline = OwnTime(std::max<std::int64_t>(0, note.deadline_ns));
  return std::max(task.process->clock.RobotTimeOf(deadline), task.reached);
}

// The process with the number that the thread's process says; 0 for any, and for a number that only
// that process knows.
pid_t Notifications::ProcessNamed(const Task& by, std::int64_t said) {
  const auto pid = static_cast<pid_t>(said);
  if (pid <= 0 || by.process->pid_namespace == 0) return pid;
  const Process* named = run_.table.NamedProcess(*by.process, pid);
  return named == nullptr ? 0 : named->pid;
}

bool Notifications::MeetsOutside(Task& task, const shm::Notification& note) {
  switch (parts_.outside.Handle(task, note)) {
    case OutsideWaits::Next::kGoesOn:
      break;
    case OutsideWaits::Next::kHolds:
      waker_.Hold(task, shm::NotificationKind::kRead);
      break;
    case OutsideWaits::Next::kHasAsked:
      parts_.descriptors.BeginAllAgain(run_.table);
      break;
  }
  return true;
}

// Equal threads have their turn.
bool Notifications::Yield(Task& task) {
  SchedulerOf(task).Yield(task.order);
  if (++task.yields < kYieldsBeforeLook) return false;
  task.yields = 0;
  return parts_.unregistered_children.LetRunBeside(*task.process);
}

bool Notifications::Handle(Task& task, const shm::Notification& note) {
  using Kind = shm::NotificationKind;
  Robot& robot = *task.process->robot;
  const EventTime when{task.reached};
  bool looks_again = false;
  if (task.process->violates_protocol) {
    parts_.violations.AwaitExit(task);
    return false;
  }
  if (const char* what = SlotCheck::WhatIsImpossible(note); what != nullptr) {
    parts_.violations.EndProcess(*task.process, what);
    return false;
  }
  const bool announces = note.kind == Kind::kSpawned || note.kind == Kind::kMadeThread;
  if (!announces) parts_.spawns.MakerSpeaks(task, when);
  task.in_vfork = false;
  task.reason = shm::WakeReason::kGo;
  task.expects_kernel = note.kind == Kind::kKernelWait;
  const VirtualTime deadline = WaitDeadlineOf(task, note);
  switch (note.kind) {
    case Kind::kRead:
    case Kind::kWrite:
      waker_.Hold(task, note.kind);
      break;
    case Kind::kIdle:
      waker_.Wait(task,
                  {.what = IdleFor(note), .deadline = deadline, .is_date = note.args[2] != 0});
      break;
    case Kind::kWaitFds:
      waker_.Wait(task, {parts_.descriptors.WatchAsAsked(task, note), deadline});
      looks_again = true;
      break;
    case Kind::kWaitChild:
      waker_.Wait(task, {awaited::Child{ProcessNamed(task, note.args[0]), note.args[1] != 0}});
      parts_.unregistered_children.LookFor(*task.process);
      // The thread has looked, and found no child that has ended; but since then one may have
      // ended. A child that the thread does not wait for stays there, so a look at the ended
      // children would never let the thread wait.
      if (std::exchange(task.children_looked, task.process->children_changed) !=
          task.process->children_changed) {
        waker_.Wake(task, shm::WakeReason::kGo, when);
      }
      break;
    case Kind::kTimerCreate:
    case Kind::kTimerSet:
    case Kind::kTimerGet:
    case Kind::kTimerDelete:
    case Kind::kTimerOverrun:
      looks_again = parts_.timers.Handle(*task.process, task, note);
      break;
    case Kind::kSpawned:
    case Kind::kMadeThread:
      parts_.spawns.Announced(task, note);
      break;
    case Kind::kYield:
      if (note.args[0] != 0) parts_.spins.PassTime(task);
      looks_again = Yield(task);
      break;
    case Kind::kSpins:
      parts_.spins.PassTime(task);
      break;
    case Kind::kPriority:
    case Kind::kPriorityGet:
    case Kind::kAffinity:
      parts_.scheduling.Handle(task, note);
      break;
    case Kind::kSetDate:
      task.reply[0] = parts_.dates.Set(task, note.args[0]);
      break;
    case Kind::kSignalled:
      parts_.signals.Sent(SentBy(run_, task, note), when);
      task.sending = {};
      break;
    case Kind::kWaitObject:
      parts_.objects.Wait(task, note, deadline);
      break;
    case Kind::kWakeObject:
      looks_again = note.args[0] == static_cast<std::int64_t>(shm::KernelObjectKind::kTerminals);
      // The kernel would have given the waiting threads what they wait for, before the waking
      // thread could take it again. So the waiting threads go first, where the waking thread's
      // policy lets them.
      if (parts_.objects.Wake(note.args[0], note.args[1], when) &&
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
      parts_.dds.Handle(task, note, deadline);
      break;
    case Kind::kQueueNotifies:
      run_.header->queues_notify.store(1);
      break;
    case Kind::kBinds:
      parts_.local_sockets.Binds(robot, static_cast<std::uint64_t>(note.args[0]),
                                 static_cast<std::uint64_t>(note.args[1]));
      break;
    case Kind::kReaches:
      parts_.local_sockets.Reaches(task, static_cast<std::uint32_t>(note.args[0]));
      waker_.Hold(task, Kind::kWrite);
      break;
    case Kind::kOutside:
      looks_again = MeetsOutside(task, note);
      break;
    case Kind::kChildUsage:
      task.reply[0] = task.process->ended_children.ChargedNs(static_cast<pid_t>(note.args[0]));
      break;
    case Kind::kCounterReads:
      WarnOfCounterReads(run_, *task.process,
                         {.places = note.args[0],
                          .first = static_cast<std::uint64_t>(note.args[1]),
                          .where = static_cast<shm::WhereReads>(note.args[2])});
      break;
    case Kind::kSignals:
      if (ReachBySignal(run_, task, ProcessNamed(task, note.args[0]))) {
        waker_.Hold(task, Kind::kWrite);
      }
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
  waker_.Refresh(robot);
  return looks_again;
}

}  // namespace tcs
