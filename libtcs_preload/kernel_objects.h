// Kernel objects that cannot be polled: a thread that changes one tells the threads that wait for
// it.
#pragma once

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"

namespace tcs::preload {

inline bool AnybodyWaits() { return g_header->object_waiters.load(std::memory_order_relaxed) != 0; }

// After a call that may end a wait that the kernel itself carries out: for a lock of a file, for
// the other end of a FIFO.
inline void TellKernelWaiters(GuestThread& thread) {
  if (g_header->kernel_waiters.load(std::memory_order_relaxed) == 0) return;
  Exchange(thread,
           Request{.kind = shm::NotificationKind::kWakeObject,
                   .args = {static_cast<std::int64_t>(shm::KernelObjectKind::kKernelWaits), 0}});
}

// After a change of the object: the threads that wait for it try again.
inline void TellChanged(GuestThread& thread, shm::KernelObjectKind kind, std::int64_t id) {
  if (!AnybodyWaits()) return;
  Exchange(thread, Request{.kind = shm::NotificationKind::kWakeObject,
                           .args = {static_cast<std::int64_t>(kind), id}});
}

}  // namespace tcs::preload
