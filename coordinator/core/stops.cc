// Processes that a signal stops, and that go on: at once, as far as others can see, though their
// threads may be at nobody's turn; and their parents hear of it.
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/signal_bits.h"

namespace tcs {

// A thread acts on a signal that stops it when it runs next. So each gets to run for that, and the
// coordinator goes on when it has stopped. Only SIGSTOP is sure to stop, so what other signals do
// to a thread that computes is seen at its dispatch.
void Engine::LetStop(const Process& process) {
  std::vector<Task*> threads;
  bool certain = false, stops = false;
  for (Task* task : process.robot->tasks) {
    if (task->process != &process || task->slot < 0) continue;
    const SignalSets sets = SignalsOf(*task);
    const std::uint64_t pending = (sets.own_pending | sets.shared_pending) & kStopSignals &
                                  ~(sets.blocked | sets.caught | sets.ignored);
    certain |= (pending & SignalBit(SIGSTOP)) != 0 || ThreadState(task->tid) == 'T';
    stops |= pending != 0;
    threads.push_back(task);
  }
  if (!certain && !stops) return;
  for (Task* task : threads) {
    const bool waits = task->state == TaskState::kWaiting;
    if (!turn_.IsOf(*task) && ThreadState(task->tid) != 'T' && (certain || waits)) {
      host_cpu_.active().LetKernelFinish(*task);
    }
    certain |= ThreadState(task->tid) == 'T';
  }
}

// Has it stopped or gone on since the last look? Then its parent hears of it.
void Engine::NoteStops(Process& process, Moment moment) {
  if (process.dead) return;
  LetStop(process);
  const bool stopped = ThreadState(process.pid) == 'T';
  if (stopped == process.stopped) return;
  process.stopped = process.stop_is_news = stopped;
  process.continue_is_news = !stopped;
  if (!stopped) LetGoOn(process);
  Process* parent = LivingProcess(process.parent);
  if (parent != nullptr) ChildChanged(*parent, process.pid, true, moment);
}

// The kernel sends the parent its signal when one of the threads runs next: those that wait may do
// that now, and are back in their waits; others when they are dispatched.
void Engine::LetGoOn(const Process& process) {
  for (Task* task : process.robot->tasks) {
    if (task->process != &process) continue;
    if (task->state != TaskState::kWaiting) {
      task->follow_up = FollowUp::kContinued;
      continue;
    }
    host_cpu_.active().LetKernelFinish(*task);
  }
}

// A child has ended, or, `by_stop`, has stopped or gone on: the parent's threads that wait for such
// a change look at it, and its signal is there.
void Engine::ChildChanged(Process& parent, pid_t child, bool by_stop, Moment moment) {
  ++parent.children_changed;
  for (Task& task : table_.tasks()) {
    const auto* wait = task.Awaits<awaited::Child>();
    if (wait == nullptr || task.process != &parent || !wait->MayBe(child)) continue;
    if (wait->stops || !by_stop) MakeReady(task, shm::WakeReason::kGo, moment);
  }
  WakeForSignals(parent, moment);
}

// Nobody says that a process has been stopped from outside.
void Engine::LookAtStops(Moment moment) {
  if (wait_counts_.for_stops() == 0) return;
  for (Process& process : table_.processes()) {
    const Process* parent = process.dead ? nullptr : LivingProcess(process.parent);
    if (parent == nullptr) continue;
    const bool awaited =
        std::any_of(table_.tasks().begin(), table_.tasks().end(), [&](const Task& task) {
          const auto* wait = task.Awaits<awaited::Child>();
          return wait != nullptr && wait->stops && task.process == parent;
        });
    if (awaited) NoteStops(process, moment);
  }
}

}  // namespace tcs
