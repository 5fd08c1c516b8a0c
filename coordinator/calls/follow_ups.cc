#include "coordinator/calls/follow_ups.h"

#include "coordinator/calls/raw_ipc.h"

namespace tcs {

void FollowUps::Do(Task& task, EventTime call, bool last) {
  // Something else may have stopped it before it has even come to the call: then once more. And
  // once more in any case, for how far it has come is not known.
  const FollowUp what = task.follow_up;
  if (last || run_.turn.HasSpoken()) {
    task.follow_up = FollowUp::kNone;
    task.brief_done = false;
  }
  switch (what) {
    case FollowUp::kNone:
      break;
    case FollowUp::kBacklogs:
      objects_.Wake(static_cast<std::int64_t>(shm::WaitKey::kBacklogs), 0, call);
      shared_events_.PassOn(task, call);
      break;
    case FollowUp::kTaken:
      shared_events_.PassOn(task, call);
      break;
    case FollowUp::kSignals:
      signals_.Sent(SentBy(run_, task, task.trapped_call), call);
      break;
    case FollowUp::kKernelWaits:
      objects_.LookAtKernelWaits(call);
      break;
    case FollowUp::kObjects: {
      objects_.LookAtKernelWaits(call);
      const KernelObject object = RawIpc::ObjectOf(task.trapped_call);
      objects_.Wake(object.kind, object.id, call);
      break;
    }
    case FollowUp::kTerminals:
      objects_.FlushTerminals(call);
      break;
    case FollowUp::kCreations:
      spawns_.LookForCreations(task, call);
      break;
    case FollowUp::kContinued:
      if (Process* parent = run_.table.LivingProcess(task.process->parent); parent != nullptr) {
        signal_wakes_.WakeForSignals(*parent, call);
      }
      break;
  }
}

}  // namespace tcs
