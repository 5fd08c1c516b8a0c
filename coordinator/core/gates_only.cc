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
  if (!gates_only_ || !turn_.lasts() || by == turn_.task()) return false;
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
  if (!turn_.lasts() || !std::exchange(says_call_, false)) return found;
  found |= TakePutOff({WrittenAt()});
  if (found.stops_running) {
    turn_.task()->parked = true;
  } else {
    opens_gate_ = true;
  }
  return found;
}

}  // namespace tcs
