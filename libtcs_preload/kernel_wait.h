// Calls in which the kernel itself may hold the thread, because only the kernel knows what they
// wait for: locks of files, the other end of a FIFO. The shim tells the coordinator before such a
// call, so that other threads get their turn at once. A thread that may have ended such a wait
// tells the coordinator afterwards (TellKernelWaiters in kernel_objects.h).
#pragma once

#include <pthread.h>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"

namespace tcs::preload {

// Makes `call`. The thread can be cancelled in it if the C library has it so.
template <class Call>
long WaitInKernel(GuestThread& thread, bool cancellable, Call call) {
  Exchange(thread, Request{.kind = shm::NotificationKind::kKernelWait});
  if (!cancellable) return call();
  int before = 0;
  pthread_setcanceltype(PTHREAD_CANCEL_ASYNCHRONOUS, &before);
  const long result = call();
  pthread_setcanceltype(before, nullptr);
  return result;
}

}  // namespace tcs::preload
