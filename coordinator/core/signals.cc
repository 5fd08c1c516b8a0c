// Signals that clients send to each other. The kernel delivers them; but a thread that waits runs
// its handler only when it is dispatched, and that is to be at the sender's virtual time.
#include <signal.h>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

namespace {

constexpr std::uint64_t Bit(int signal) { return std::uint64_t{1} << (signal - 1); }

// What of `pending` makes a thread with these sets run or end. What only stops it does so when it
// runs next.
std::uint64_t Deliverable(std::uint64_t pending, const SignalSets& sets, std::uint64_t blocked) {
  constexpr std::uint64_t kStops = Bit(SIGSTOP) | Bit(SIGTSTP) | Bit(SIGTTIN) | Bit(SIGTTOU);
  return pending & ~blocked & ~(kStops & ~sets.caught);
}

}  // namespace

// What is for the whole process goes to the first of its threads that does not block it, as the
// kernel has it.
void Engine::WakeForSignals(Process& process) {
  std::uint64_t taken = 0;
  for (Task& task : tasks_) {
    if (task.process != &process || task.state == TaskState::kDead) continue;
    const SignalSets sets = ReadSignalSets(task.tid);
    const std::uint64_t blocked = task.has_wait_mask ? task.wait_mask : sets.blocked;
    const std::uint64_t mine =
        Deliverable(sets.own_pending | (sets.shared_pending & ~taken), sets, blocked);
    taken |= mine;
    if (mine != 0 && task.state == TaskState::kWaiting) {
      MakeReady(task, shm::WakeReason::kSignal);
    }
  }
}

void Engine::WakeSignalled(pid_t receiver) {
  for (Process& process : processes_) {
    if (!process.dead && (receiver <= 0 || process.pid == receiver)) WakeForSignals(process);
  }
}

}  // namespace tcs
