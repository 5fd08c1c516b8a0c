// Which of the process's descriptors are virtual timers.
#pragma once

#include <cstdint>

#include "libtcs_preload/virtual_clock.h"

namespace tcs::preload {

struct TimerFd {
  int fd = -1;
  Clock clock = Clock::kMonotonic;
  std::int64_t id = 0;    // the coordinator's
  bool is_short = false;  // the timer's interval: see coordinator/queues/process_timers.h
};

// False if no room is left.
bool RememberTimerFd(int fd, std::int64_t id, Clock clock);
TimerFd* FindTimerFd(int fd);

// Whether `fd` is a virtual timer, checked: false if the descriptor was closed without the shim's
// knowledge and its number now belongs to another descriptor.
bool IsTimerFd(int fd);

// The timer's interval is a short one, or is none any more.
void NoteShortTimer(std::int64_t id, bool is_short);

// `copy` is now another descriptor for the same timer.
void CopyTimerFd(int fd, int copy);

// `fd` is closed. Returns the timer's id if no descriptor of this process refers to it any more,
// else 0.
std::int64_t ForgetTimerFd(int fd);

}  // namespace tcs::preload
