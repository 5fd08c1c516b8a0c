// Calls in which the kernel itself may hold the thread, for it alone knows what they wait for:
// locks of files, the other end of a FIFO. The coordinator is told before, so that others get their
// turn at once; whoever may end such a wait tells it after (TellKernelWaiters in keys.h).
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
