// The kernel's names for what the C library calls pthread_t and cpu_set_t.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <string.h>

#include <cstddef>

#include "libtcs_preload/real.h"
#include "shm/clock_ids.h"

namespace tcs::preload {

// -1 if the thread has ended. The C library tells the number only as part of the clock's; from
// glibc 2.43 on it is 0 there when a thread is about to end.
inline pid_t TidOf(pthread_t thread) {
  clockid_t clock;
  if (TCS_REAL(pthread_getcpuclockid)(thread, &clock) != 0) return -1;
  const pid_t tid = shm::ClockOf(clock).owner;
  return tid > 0 ? tid : -1;
}

// The first 64 cores of a set; bit 0 is core 0.
inline unsigned long CoresIn(std::size_t size, const cpu_set_t* set) {
  unsigned long cores = 0;
  memcpy(&cores, set, size < sizeof cores ? size : sizeof cores);
  return cores;
}

}  // namespace tcs::preload
