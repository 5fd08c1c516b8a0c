// Waiting for descriptors in virtual time.
#pragma once

#include <poll.h>

#include <cstdint>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

enum class WaitResult { kRetry, kTimedOut, kInterrupted };

// Stops the thread until one of `fds` (negative ones are passed over) may be ready, one of
// `waiting`'s signals, which the thread blocks, is pending, or `deadline_ns` is reached. kRetry:
// probe again: everything sent until then is there. What was sent up to the call but was not there
// yet ends the wait at the time of the call, so no caller needs to hold before.
//
// Several threads may wait for one descriptor to take what there is. One event wakes one of them:
// the one that has waited longest, or, at an epoll set, the one that came last. `again`: the thread
// was woken, and found nothing. When it has taken something, it calls PassOn, so that the next
// thread gets what it has left.
enum class OneEvent { kForAll = 0, kForTheFirst = 1, kForTheLast = 2 };
struct Waiting {
  OneEvent event = OneEvent::kForAll;
  bool again = false;
  unsigned long signals = 0;  // bit 0 is signal 1
};
WaitResult WaitForFds(GuestThread& thread, const pollfd* fds, unsigned long count,
                      std::int64_t deadline_ns, const Waiting& waiting = {});
void PassOn(GuestThread& thread);

// Waits until `fd` shows one of `events`, unless it is non-blocking. kReady: it did at once, or
// waiting is not wanted: hold, then make the call. kWaited: make the call now. kFailed: errno is
// set (EAGAIN past `deadline_ns`, EINTR). `looked`: the caller has just found that it is none of
// the former two.
enum class FdState { kReady, kWaited, kFailed };
FdState AwaitFd(GuestThread& thread, int fd, short events, std::int64_t deadline_ns,
                bool looked = false);

// True if `fd` shows one of `events` now.
bool PollNow(int fd, short events);

// HoldForRead, unless others cannot change what the call finds. It takes a datagram that is there
// already: that is from the past, and comes first whatever else is still sent. Or it reads a timer,
// which expires at no time that the thread's horizon does not stop at. True if it held: another
// thread may have taken what was there.
bool HoldForReadFrom(GuestThread& thread, int fd, bool socket);

bool IsNonBlocking(int fd);

// True if calls on `fd` can wait for another program or thread: sockets, pipes, terminals, event
// descriptors. `is_socket` is told which of them, if given.
bool CanWait(int fd, bool* is_socket = nullptr);

// The descriptor's SO_RCVTIMEO or SO_SNDTIMEO as a deadline from now.
std::int64_t SocketDeadline(GuestThread& thread, int fd, int option);

}  // namespace tcs::preload
