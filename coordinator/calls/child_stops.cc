#include "coordinator/calls/child_stops.h"

#include <signal.h>
#include <sys/wait.h>

#include <algorithm>

#include "coordinator/os/signal_bits.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/signal_sets.h"

namespace tcs {

// A thread acts on a signal that stops it when it runs next. So each thread gets to run for that,
// and the coordinator goes on when the thread has stopped. Only SIGSTOP is sure to stop, so what
// other signals do to a thread that computes is seen at its dispatch.
void ChildStops::LetStop(const Process& process) {
  std::vector<Task*> threads;
  bool certain = false, stops = false;
  for (Task* task : process.robot->tasks) {
    if (task->process != &process || task->slot < 0) continue;
    const SignalSets sets = SignalsOf(run_, *task);
    const std::uint64_t pending = (sets.own_pending | sets.shared_pending) & kStopSignals &
                                  ~(sets.blocked | sets.caught | sets.ignored);
    certain |= (pending & SignalBit(SIGSTOP)) != 0 || ThreadState(task->tid) == 'T';
    stops |= pending != 0;
    threads.push_back(task);
  }
  if (!certain && !stops) return;
  for (Task* task : threads) {
    const bool waits = task->state == TaskState::kWaiting;
    if (!run_.turn.IsOf(*task) && ThreadState(task->tid) != 'T' && (certain || waits)) {
      active_.LetKernelFinish(*task);
    }
    certain |= ThreadState(task->tid) == 'T';
  }
}

void ChildStops::Look(Process& process, EventTime when) {
  if (process.dead) return;
  LetStop(process);
  const bool stopped = ThreadState(process.pid) == 'T';
  if (stopped == process.stopped) return;
  process.stopped = process.stop_is_news = stopped;
  process.continue_is_news = !stopped;
  if (!stopped) LetGoOn(process);
  Process* parent = run_.table.LivingProcess(process.parent);
  if (parent != nullptr) ChildChanged(*parent, process.pid, true, when);
}

// The kernel sends the parent its signal when one of the child's threads runs next. Threads that
// wait may run for that now, and are back in their waits; other threads do so when they are
// dispatched.
void ChildStops::LetGoOn(const Process& process) {
  for (Task* task : process.robot->tasks) {
    if (task->process != &process) continue;
    if (task->state != TaskState::kWaiting) {
      task->after_call = AfterCall::kContinued;
      continue;
    }
    active_.LetKernelFinish(*task);
  }
}

void ChildStops::ChildChanged(Process& parent, pid_t child, bool by_stop, EventTime when) {
  ++parent.children_changed;
  for (Task& task : run_.table.tasks()) {
    const auto* wait = task.Awaits<awaited::Child>();
    if (wait == nullptr || task.process != &parent || !wait->MayBe(child)) continue;
    if (wait->stops || !by_stop) waker_.Wake(task, shm::WakeReason::kGo, when);
  }
  wakes_.WakeForSignals(parent, when);
}

void ChildStops::LookAtAwaited(EventTime when) {
  if (waker_.counts().for_stops() == 0) return;
  for (Process& process : run_.table.processes()) {
    const Process* parent = process.dead ? nullptr : run_.table.LivingProcess(process.parent);
    if (parent == nullptr) continue;
    const bool awaited =
        std::any_of(run_.table.tasks().begin(), run_.table.tasks().end(), [&](const Task& task) {
          const auto* wait = task.Awaits<awaited::Child>();
          return wait != nullptr && wait->stops && task.process == parent;
        });
    if (awaited) Look(process, when);
  }
}

}  // namespace tcs
