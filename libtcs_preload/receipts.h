// The shim's notes of messages that a thread receives and sends, and of its sleeps, for its
// activations (shm/receipts.h). Async-signal-safe.
#pragma once

#include "libtcs_preload/guest.h"

namespace tcs::preload {

// The calling thread has received something that others, or a timer, have sent.
void NoteReceived(GuestThread& thread, shm::Receipts::Of of = shm::Receipts::Of::kMessage);

// As NoteReceived, for bytes that the thread has just read from a descriptor that is no socket.
// Descriptors by which a program's own threads wake each other (eventfd, signalfd) count for
// nothing.
void NoteReceivedFrom(GuestThread& thread, int fd, bool has_name);

// The thread sleeps until `until_ns` without asking for it. The sleep began at `from_ns`, when the
// thread's charge was `cpu_ns`.
void NoteSlept(GuestThread& thread, std::int64_t from_ns, std::int64_t cpu_ns,
               std::int64_t until_ns);

inline void NoteSent(GuestThread& thread) { shm::NoteSent(thread.slot->receipts); }

}  // namespace tcs::preload
