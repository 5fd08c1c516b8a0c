// What is due after a call that was let through to the kernel: others may go on by what it did, at
// the time of the call. So its thread runs just long enough for the kernel to carry it out, and is
// stopped for that.
#include <utility>

#include "coordinator/core/engine.h"

namespace tcs {

// The thread has run since the kernel got the call, which it made at `call`.
void Engine::DoFollowUp(Task& task, Moment call, bool last) {
  // Something else may have stopped it before it has even come to the call: then once more. And
  // once more in any case, for how far it has come is not known.
  const FollowUp what = task.follow_up;
  if (last || turn_.HasSpoken()) {
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
      signals_.Sent(0, call);
      break;
    case FollowUp::kKernelWaits:
      objects_.LookAtKernelWaits(call);
      break;
    case FollowUp::kContinued:
      if (Process* parent = LivingProcess(task.process->parent); parent != nullptr) {
        signal_wakes_.WakeForSignals(*parent, call);
      }
      break;
  }
}

}  // namespace tcs
