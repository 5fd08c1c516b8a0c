#include "coordinator/processes/protocol_violations.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "coordinator/port/pidfds.h"
#include "coordinator/port/waits.h"

namespace tcs {

namespace {

constexpr HostDuration kMostExit = HostDuration::Seconds(1);

}  // namespace

// The process's threads get to their end at once, and no other thread runs meanwhile: the end takes
// the kernel some steps.
void ProtocolViolations::EndProcess(Process& process, const char* what) {
  if (std::exchange(process.violates_protocol, true)) return;
  if (!std::exchange(process.client->has_erred, true))
    run_.Warn(
        fmt::format("{} (pid {}) has written an impossible value into the memory that it shares "
                    "with tcs ({}), and was ended; look for a stray pointer in it",
                    process.name, process.pid, what));
  KillByPidfd(process.pidfd.get());
  cpu_.active().HoldLast();
  const std::vector<Task*> threads = process.robot->tasks;
  for (Task* task : threads) {
    if (task->process != &process) continue;
    cpu_.active().LetRun(*task);
    if (!run_.turn.IsOf(*task)) AwaitExit(*task);
  }
  AwaitReadable(process.pidfd.get(), kMostExit);
}

void ProtocolViolations::AwaitExit(Task& task) {
  waker_.Leave(task);
  waker_.Wait(task, {awaited::Nothing{}});
  waker_.Refresh(*task.process->robot);
}

}  // namespace tcs
