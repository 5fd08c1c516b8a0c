#include "coordinator/calls/trapped_waits.h"

#include <errno.h>

#include <algorithm>

#include "coordinator/calls/call_files.h"
#include "coordinator/calls/syscall_ipc.h"
#include "coordinator/calls/syscall_polls.h"
#include "coordinator/calls/syscall_semaphores.h"
#include "coordinator/calls/syscall_transfers.h"
#include "coordinator/tasks/client_values.h"

namespace tcs {

// A signal is to end a trapped call that waits: the kernel ends the call, as it ends its own. The
// kernel decides by what it finds in the thread, the handler's flags or that no handler runs, and
// not by what is known here.
void TrappedWaits::Interrupt(Task& task) {
  const Wait& wait = *task.wait;
  task.trap_continues = false;
  task.trap_result =
      wait.deadline.IsNever() ? -by_signal::kAsFlagsSay : -by_signal::kAgainUnlessRun;
  // A call that accepts signals is not made again for other signals.
  if (wait.As<awaited::Signals>() != nullptr) task.trap_result = -by_signal::kAgainUnlessRun;
  if (const auto* futex = wait.As<awaited::Futex>(); futex != nullptr) {
    // A lock is never given up for a signal: the C library would take it for acquired.
    if (futex->owner != awaited::kNobody || words_.table().ExpectedLock(task.order).has_value()) {
      task.trap_result = -by_signal::kAgain;
    }
    if (futex->was_requeued) task.trap_result = -EAGAIN;
    if (words_.table().WaitsForAny(task.order)) task.trap_result = -by_signal::kAsFlagsSay;
  }
  const auto* sleep = wait.As<awaited::Time>();
  if (sleep != nullptr && sleep->remaining_address != 0) {
    const VirtualDuration left = std::max(VirtualDuration(), wait.deadline - task.reached);
    if (!Write(task, sleep->remaining_address, ToTimespec(left.ns()))) task.trap_result = -EFAULT;
  }
}

void TrappedWaits::Finish(Task& task, shm::WakeReason reason) {
  if (reason == shm::WakeReason::kSignal) return Interrupt(task);
  if (task.slot >= 0) SlotOf(task).waits_in_call.store(0);
  const bool timed_out = reason == shm::WakeReason::kDeadline;
  task.trap_result = 0;
  if (const auto* futex = task.Awaits<awaited::Futex>(); futex != nullptr) {
    task.trap_result = timed_out ? -ETIMEDOUT : static_cast<std::int64_t>(futex->woken_word);
  }
  if (const auto* child = task.Awaits<awaited::Child>(); child != nullptr && child->stops) {
    children_.ForgetNews(*task.process);
  }
  if (const auto* queue = task.Awaits<awaited::Queue>(); queue != nullptr && !timed_out) {
    if (!AreSemaphores(static_cast<int>(queue->of.id))) {
      task.trap_continues = false;
      task.trap_result = -EIDRM;  // the semaphores were there when the wait began
    }
  }
  if (timed_out &&
      (task.Awaits<awaited::Queue>() != nullptr || task.Awaits<awaited::Signals>() != nullptr)) {
    task.trap_continues = false;
    task.trap_result = SyscallIpc::ResultAtDeadline(task.trapped_call);
  }
  const auto* watched = task.Awaits<awaited::Descriptors>();
  if (watched == nullptr) return;
  if (!timed_out) {
    if (watched->transfers && SyscallTransfers::Receives(task.trapped_call))
      activations_.ReceivedRaw(task, false);
    return;
  }
  task.trap_continues = false;
  if (watched->transfers) {
    task.trap_result = SyscallIpc::ResultAtDeadline(task.trapped_call);
  } else if (!CallFiles::Keeps(task, *watched)) {  // kept files are looked at once more
    SyscallPolls::ClearResult(task, task.trapped_call);
  }
}

}  // namespace tcs
