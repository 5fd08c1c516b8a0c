#include "coordinator/processes/expulsion.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <utility>
#include <vector>

namespace tcs {

namespace {

constexpr int kDeathMs = 1000;

}  // namespace

// Its threads get to the end at once, and nobody runs meanwhile: it takes the kernel some steps.
void Expulsion::Expel(Process& process, const char* what) {
  if (std::exchange(process.expelled, true)) return;
  if (!std::exchange(process.client->has_erred, true))
    run_.Warn(
        fmt::format("{} (pid {}) has written an impossible value into the memory that it shares "
                    "with tcs ({}), and was ended; look for a stray pointer in it",
                    process.name, process.pid, what));
  syscall(SYS_pidfd_send_signal, process.pidfd.get(), SIGKILL, nullptr, 0);
  cpu_.active().HoldLast();
  const std::vector<Task*> threads = process.robot->tasks;
  for (Task* task : threads) {
    if (task->process != &process) continue;
    cpu_.active().LetRun(*task);
    if (!run_.turn.IsOf(*task)) AwaitDeath(*task);
  }
  pollfd end{process.pidfd.get(), POLLIN, 0};
  poll(&end, 1, kDeathMs);
}

void Expulsion::AwaitDeath(Task& task) {
  waker_.Leave(task);
  waker_.Wait(task, {awaited::Nothing{}});
  waker_.Refresh(*task.process->robot);
}

}  // namespace tcs
