// A thread of a client, as the processor of the host sees it on which it runs.
#pragma once

#include <sys/types.h>

namespace tcs {

struct HostThread {
  pid_t tid = 0;
  bool may_run = false;  // while the coordinator sleeps (active_threads.h)
  bool parked = true;    // at its gate, rather than stopped by priority
};

}  // namespace tcs
