// Running without the right to real-time priorities: nothing but its gate keeps a thread that is
// not dispatched from running. Its calls begin there, so that all it can do by itself is compute,
// which its clock does not show. What such threads do get the coordinator to hear is put off until
// the dispatched one has come to the end of what it does to others. It says so where its next call
// begins (kCall): until then its clock stands at the time of its last call, and what it has made
// ready becomes ready at that time, however late the coordinator looks.
#include <utility>

#include "coordinator/core/engine.h"

namespace tcs {

// True if what `by` does happens later.
bool Engine::PutOff(const Task* by, Late late) {
  if (!gates_only_ || (turn_.lasts() && by == turn_.task())) return false;
  if (!turn_.lasts() && put_off_.empty()) return false;  // nothing came before it
  put_off_.push_back(std::move(late));
  return true;
}

Reactor::Found Engine::TakePutOff(Moment moment) {
  Reactor::Found found;
  for (const Late& late : std::exchange(put_off_, {})) found |= late(moment);
  return found;
}

// Of the running thread's: true if it does not end its turn.
bool Engine::MayGoOn(const Task& task) {
  const shm::ThreadSlot& slot = Slot(task);
  if (slot.note.kind == shm::NotificationKind::kCall) {
    says_call_ = true;
    return true;
  }
  // It said so before it was dispatched.
  return slot.note.kind == shm::NotificationKind::kInterrupted &&
         slot.gate.load() == shm::kGateOpen;
}

// All events of this instant have been handled. If nobody has to run instead, the running thread
// goes on with its call.
Reactor::Found Engine::EndCall(Reactor::Found found) {
  if (!turn_.lasts() || !says_call_) return found;
  const Moment moment{WrittenAt()};
  found |= TakePutOff(moment);
  while (std::exchange(found.looks_again, false)) found |= TakeEvents(0, moment, true);
  says_call_ = false;
  if (found.stops_running) {
    Task& task = *turn_.task();
    task.parked = true;
    // It was found held by the kernel, and has come back at the same instant.
    if (task.state == TaskState::kUnseen) SetState(task, TaskState::kReady);
  } else {
    opens_gate_ = true;
  }
  return found;
}

}  // namespace tcs
