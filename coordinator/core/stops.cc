// Processes that a signal stops, and that go on: at once, as far as others can see, though their
// threads may be at nobody's turn; and their parents hear of it.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

namespace {

// So long the kernel gets to stop threads that have nothing else to do.
constexpr int kStopTurns = 50;
constexpr useconds_t kStopTurnUs = 20;

constexpr std::uint64_t Bit(int signal) { return std::uint64_t{1} << (signal - 1); }

constexpr std::uint64_t kStops = Bit(SIGSTOP) | Bit(SIGTSTP) | Bit(SIGTTIN) | Bit(SIGTTOU);

bool IsGone(char state) { return state == 'Z' || state == 'X'; }

}  // namespace

// A thread acts on a signal that stops it when it runs next; so all of the process's get to run,
// which they do only for that. What does not stop them (the kernel spares orphans some of these
// signals) brings those that wait back to their gates.
void Engine::LetStop(const Process& process) {
  std::vector<Task*> threads;
  bool stops = false;
  for (Task* task : process.robot->tasks) {
    if (task->process != &process || task->slot < 0) continue;
    const SignalSets sets = ReadSignalSets(task->tid);
    const std::uint64_t pending = sets.own_pending | sets.shared_pending;
    stops |= (pending & kStops & ~(sets.blocked | sets.caught | sets.ignored)) != 0 ||
             ThreadState(task->tid) == 'T';
    threads.push_back(task);
  }
  if (!stops) return;
  const auto has_to_stop = [](const Task* task) {
    const char state = ThreadState(task->tid);
    return state != 'T' && !IsGone(state);
  };
  for (int turn = 0; turn < kStopTurns; ++turn) {
    bool some = false;
    for (Task* task : threads) {
      if (!has_to_stop(task)) continue;
      some = true;
      SetLevel(task->tid, Level::kActive);
    }
    if (!some) break;
    usleep(kStopTurnUs);
  }
  for (Task* task : threads) {
    if (task == running_) continue;
    SetLevel(task->tid, Level::kWaiting);
    task->level = Level::kWaiting;
  }
}

// Has it stopped or gone on since the last look? Then its parent hears of it.
void Engine::NoteStops(Process& process) {
  if (process.dead) return;
  LetStop(process);
  const bool stopped = ThreadState(process.pid) == 'T';
  if (stopped == process.stopped) return;
  process.stopped = process.stop_is_news = stopped;
  process.continue_is_news = !stopped;
  if (!stopped) LetGoOn(process);
  TellParent(process);
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
    SetLevel(task->tid, Level::kActive);
    for (int turn = 0; turn < kStopTurns && ThreadState(task->tid) == 'R'; ++turn) {
      usleep(kStopTurnUs);
    }
    SetLevel(task->tid, Level::kWaiting);
    task->level = Level::kWaiting;
  }
}

// Those who wait for such a change of a child look at it, and its signal is there.
void Engine::TellParent(const Process& child) {
  Process* parent = LivingProcess(child.parent);
  if (parent == nullptr) return;
  ++parent->children_changed;
  for (Task& task : tasks_) {
    if (task.waits_for_child && task.awaits_stops && task.process == parent &&
        (task.awaited_child <= 0 || task.awaited_child == child.pid)) {
      MakeReady(task, shm::WakeReason::kGo);
    }
  }
  WakeForSignals(*parent);
}

// Nobody says that a process has been stopped from outside.
void Engine::LookAtStops() {
  if (waiting_for_stops_ == 0) return;
  for (Process& process : processes_) {
    const Process* parent = process.dead ? nullptr : LivingProcess(process.parent);
    if (parent == nullptr) continue;
    const bool awaited = std::any_of(tasks_.begin(), tasks_.end(), [&](const Task& task) {
      return task.awaits_stops && task.process == parent;
    });
    if (awaited) NoteStops(process);
  }
}

}  // namespace tcs
