// Waiting for descriptors in virtual time.
#pragma once

#include <poll.h>

#include <cstdint>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

class CallFile;

enum class WaitResult { kRetry, kTimedOut, kInterrupted };
WaitResult ResultOf(shm::WakeReason reason);

// Stops the thread until one of `fds` (negative ones are passed over) may be ready, one of
// `waiting`'s signals, which the thread blocks, is pending, or `deadline_ns` is reached. kRetry:
// probe again: everything sent until then is there. Data that was sent up to the call but was not
// there yet ends the wait at the time of the call, so no caller needs to hold before.
//
// Several threads may wait for one descriptor to take what there is. One event wakes one of these
// threads: the one that has waited longest, or, at an epoll set, the one that came last. `again`:
// the thread was woken, and found nothing. When the thread has taken something, it calls PassOn, so
// that the next thread gets what it has left.
enum class OneEvent { kForAll = 0, kForTheFirst = 1, kForTheLast = 2 };
struct Waiting {
  OneEvent event = OneEvent::kForAll;
  bool again = false;
  unsigned long signals = 0;  // bit 0 is signal 1
  // Of the files whose numbers mean other files afterwards, or none (GuestThread::keeps_files).
  shm::KeepFiles keep = shm::KeepFiles::kNot;
};
WaitResult WaitForFds(GuestThread& thread, const pollfd* fds, unsigned long count,
                      std::int64_t deadline_ns, const Waiting& waiting = {});
void PassOn(GuestThread& thread);

// Waits until the file shows one of `events`, unless it is non-blocking. kReady: the file showed
// one at once, or waiting is not wanted: hold, then make the call. kWaited: make the call now.
// kFailed: errno is set (EAGAIN past `deadline_ns`, EINTR).
enum class FdState { kReady, kWaited, kTimedOut, kFailed };
FdState AwaitFd(CallFile& file, short events, std::int64_t deadline_ns);

// As AwaitFd, for a caller that has found nothing, and finds out by itself whether there is
// something now. kWaited: there may be something. kTimedOut: there may be, for the last time.
// `again`: the caller has waited so before, and found nothing.
FdState AwaitEvent(CallFile& file, short events, std::int64_t deadline_ns, bool again);

// True if `fd` shows one of `events` now.
bool PollNow(int fd, short events);

// HoldForRead, unless others cannot change what the call finds. The call takes a datagram that is
// there already: such a datagram is from the past, and comes first whatever else is still sent. Or
// the call reads a timer, which expires at no time that the thread's horizon does not stop at. True
// if the thread has held: another thread may have taken what was there.
bool HoldForReadFrom(GuestThread& thread, int fd, bool socket);

bool IsNonBlocking(int fd);

// True if calls on `fd` can wait for another program or thread: sockets, pipes, terminals, event
// descriptors. `kind`, if given, is set to which of them.
enum class FdKind { kSocket, kWithoutName, kOther };  // without: event descriptors and their like
bool CanWait(int fd, FdKind* kind = nullptr);

// The descriptor's SO_RCVTIMEO or SO_SNDTIMEO as a deadline from now.
std::int64_t SocketDeadline(GuestThread& thread, int fd, int option);

}  // namespace tcs::preload
