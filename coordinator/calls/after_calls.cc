#include "coordinator/calls/after_calls.h"

#include "coordinator/calls/syscall_ipc.h"

namespace tcs {

void AfterCalls::Do(Task& task, EventTime call, bool last) {
  // Something else may have stopped the thread before it has even come to the call: then this is
  // done once more. It is done once more in any case, because how far the thread has come is not
  // known.
  const AfterCall what = task.after_call;
  if (last || run_.turn.HasSpoken()) {
    task.after_call = AfterCall::kNone;
    task.brief_done = false;
  }
  switch (what) {
    case AfterCall::kNone:
      break;
    case AfterCall::kBacklogs:
      objects_.Wake(static_cast<std::int64_t>(shm::KernelObjectKind::kBacklogs), 0, call);
      shared_events_.PassOn(task, call);
      break;
    case AfterCall::kTaken:
      shared_events_.PassOn(task, call);
      break;
    case AfterCall::kSignals:
      signals_.Sent(SentBy(run_, task, task.trapped_call), call);
      break;
    case AfterCall::kKernelWaits:
      objects_.LookAtKernelWaits(call);
      break;
    case AfterCall::kObjects: {
      objects_.LookAtKernelWaits(call);
      const KernelObject object = SyscallIpc::ObjectOf(task.trapped_call);
      objects_.Wake(object.kind, object.id, call);
      break;
    }
    case AfterCall::kTerminals:
      objects_.FlushTerminals(call);
      break;
    case AfterCall::kCreations:
      spawns_.LookForCreations(task, call);
      break;
    case AfterCall::kContinued:
      if (Process* parent = run_.table.LivingProcess(task.process->parent); parent != nullptr) {
        signal_wakes_.WakeForSignals(*parent, call);
      }
      break;
  }
}

}  // namespace tcs
