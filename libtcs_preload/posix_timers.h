// The process's timers of timer_create. Kept in memory that a fork leaves zeroed in the child,
// which inherits none. No locks: a place is claimed by one compare-and-swap.
#pragma once

#include <signal.h>
#include <time.h>

#include <cstdint>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

struct PosixTimer {
  enum State : std::uint32_t { kFree = 0, kTaken = 1, kLive = 2, kEnding = 3 };
  State state;
  clockid_t clock;
  std::int64_t id;  // the coordinator's; the program's timer_t is the same number
  // Of SIGEV_THREAD: the helper thread waits on timer_fd and starts a thread at each expiration.
  int timer_fd;
  int overruns;
  void (*function)(sigval);
  sigval value;
  std::size_t stack_size, guard_size;
};

// Null if no room is left.
PosixTimer* ClaimPosixTimer();
// Null if there is no timer of this name.
PosixTimer* FindPosixTimer(timer_t name);
void FreePosixTimer(PosixTimer* timer);

// Starts the thread that runs the timer's function at its expirations; false without resources.
bool StartTimerThread(PosixTimer* timer);

}  // namespace tcs::preload
