// One exchange with the coordinator: fill the slot's record, write its index into the pipe, stop at
// the gate.
#pragma once

#include <cstdint>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

struct Request {
  shm::NotificationKind kind;
  std::int64_t deadline_ns = shm::kNeverNs;
  std::int64_t args[4] = {};
  const shm::WaitFd* fds = nullptr;
  std::uint32_t fd_count = 0;
  // A signal handler that runs meanwhile ends the exchange with WakeReason::kSignal, and the thread
  // can be cancelled.
  bool interruptible = false;
  // The kernel's signal mask to wait with for a handler, instead of at the gate; null: the gate.
  const unsigned long* suspend_mask = nullptr;
  // The signals that the program blocks, in a handler that it does not know of; null: the thread is
  // in no such handler.
  const unsigned long* blocked = nullptr;
};

struct Reply {
  shm::WakeReason reason;
  std::int64_t values[2];
};

// Returns when the coordinator dispatches the thread again. Async-signal-safe, and may be called
// from a handler that interrupted another exchange of the same thread: the outer one then ends as
// interrupted.
Reply Exchange(GuestThread& thread, const Request& request);

// At the beginning of a call, where nothing but its gate keeps a thread from running on: returns
// once the coordinator has seen what the thread's last call did to others, and has dispatched the
// thread.
void AwaitTurn(GuestThread& thread);

// True while the thread has a turn beside others, before its order: an effect on others that comes
// at once has to wait for the order. Any exchange ends such a turn.
bool IsBeside(const GuestThread& thread);

// True in a handler that has interrupted an exchange of the thread's whose answer is not there yet.
bool IsAtGate(const GuestThread& thread);

// A handler of the program's begins. If it has interrupted an exchange on its way to the gate, the
// thread does not wait there as if nothing had come.
void NoteHandler(GuestThread& thread);

// Before the handler executes anything of the program's: where nothing but its gate keeps the
// thread from running on, and the thread has no turn, it waits for one. The coordinator hears that
// the handler ends a wait, however long the handler computes before its first call.
void AwaitTurnOfHandler(GuestThread& thread);

// The gate without a notification: the attach itself was one.
void AwaitFirstDispatch(GuestThread& thread);

// The gate without a notification in a handler that has interrupted an exchange: the exchange has
// notified.
void AwaitDispatch(GuestThread& thread);

}  // namespace tcs::preload
