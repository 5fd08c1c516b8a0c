// The order on the one processor that all processes of a run share (paper, section 3): the
// coordinator preempts everybody, the active thread preempts the detector, and the detector runs
// exactly when the active thread has blocked in the kernel.
#pragma once

#include <sys/types.h>

namespace tcs {

// A thread that is to do only what the kernel has to do for it does that at once, above the
// coordinator (kKernelOnly).
enum class Level : int {
  kWaiting = 10,
  kDetector = 11,
  kActive = 12,
  kCoordinator = 13,
  kKernelOnly = 14
};

// The thread, 0 for the calling one, runs on that CPU only. While the thread runs on another CPU
// the caller sleeps until the thread has stopped. False if the kernel does not let it.
bool BindTo(pid_t tid, int cpu);
// Whether the thread is bound to that CPU alone.
bool IsBoundTo(pid_t tid, int cpu);

// False where levels are not permitted (real_time_facts.h).
bool SetLevel(pid_t tid, Level level);

// From now on SetLevel does nothing in this process and its forks, as where levels are not
// permitted.
void UseNoLevels();

// The thread, 0 for the calling one, runs only when hardly any other thread on its CPU wants to.
// Every user may do that.
void RunOnlyWhenIdle(pid_t tid = 0);

// For the calling thread, at ordinary priority: the thread's timers are not put off, and it
// preempts threads that compute when it wakes, as far as the kernel lets it. Every user may do
// that.
void BeWokenInTime();

// Back to ordinary scheduling.
void LeaveRealTime(pid_t tid);

}  // namespace tcs
