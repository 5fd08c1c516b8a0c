// Trapped calls that have waited for files which are no longer under their numbers. The kernel
// would carry such a call out on the file that its number means now, so the call is carried out
// here, on the coordinator's copy of the file. The call waits again where there is nothing for it
// after all.
//
// Calls on terminals are left to the kernel. Messages that are sent carry the coordinator's
// credentials where the program names none.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/calls/descriptor_waits.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class KeptCalls {
 public:
  KeptCalls(Waker& waker, DescriptorWaits& descriptors)
      : waker_(waker), descriptors_(descriptors) {}

  // The thread is about to go on, by its trapped call's result or the kernel's. True: the thread
  // waits again instead.
  bool WaitsAgain(Task& task);

 private:
  void WaitAgain(Task& task);

  Waker& waker_;
  DescriptorWaits& descriptors_;
};

}  // namespace tcs
