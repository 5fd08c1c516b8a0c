#include "coordinator/calls/kept_calls.h"

#include <errno.h>

#include <utility>

#include "coordinator/calls/call_files.h"
#include "coordinator/calls/kept_transfers.h"
#include "coordinator/calls/syscall_polls.h"
#include "coordinator/os/open_files.h"

namespace tcs {

namespace {

bool HasTimedOut(const Task& task) { return task.reason == shm::WakeReason::kDeadline; }

std::int64_t PollAgain(const Task& task, const TrappedCall& call) {
  const std::int64_t found = SyscallPolls::Again(task, call, task.kept->files.front().get());
  return found == 0 && !HasTimedOut(task) ? -EAGAIN : found;
}

}  // namespace

bool KeptCalls::WaitsAgain(Task& task) {
  if (task.trap_id == 0 || !task.kept.has_value()) return false;
  const TrappedCall call = task.trapped_call;
  const bool transfers = task.kept->transfers;
  CallFiles::LookAtNumbers(task);
  if (!task.kept.has_value()) {
    if (!transfers && !task.trap_continues && HasTimedOut(task))
      SyscallPolls::ClearResult(task, call);
    return false;
  }
  // A transfer that has timed out is over, and has its result.
  const bool is_over = transfers && !task.trap_continues;
  if (!is_over && !IsTerminal(task.kept->files.front().get())) {
    const std::int64_t result =
        transfers ? KeptTransfers::CarryOut(task, call) : PollAgain(task, call);
    if (result == -EAGAIN) {
      WaitAgain(task);
      return true;
    }
    task.trap_result = result;
    task.trap_continues = false;
  }
  task.kept.reset();
  return false;
}

void KeptCalls::WaitAgain(Task& task) {
  task.trap_continues = true;
  const VirtualTime deadline = task.kept->deadline;
  const bool transfers = task.kept->transfers;
  awaited::Descriptors watched = descriptors_.WatchKept(task);
  watched.transfers = transfers;
  watched.takes = transfers && watched.fds.size() == 1;
  if (watched.takes) watched.events = watched.asked[0].events;
  if (task.state == TaskState::kHolding) waker_.SetState(task, TaskState::kReady);
  SlotOf(task).waits_in_call.store(1);
  waker_.Wait(task, {std::move(watched), deadline, true});
}

}  // namespace tcs
