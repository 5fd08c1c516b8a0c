// Waiting for descriptors in virtual time.
#pragma once

#include <poll.h>

#include <cstdint>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

enum class WaitResult { kRetry, kTimedOut, kInterrupted };

// Stops the thread until one of `fds` (negative ones are passed over) may be ready or `deadline_ns`
// is reached. kRetry: probe again. The probe that said "not ready" came before, under HoldForRead.
WaitResult WaitForFds(GuestThread& thread, const pollfd* fds, unsigned long count,
                      std::int64_t deadline_ns);

// Waits until `fd` shows one of `events`, unless it is non-blocking. True: make the call now; the
// caller has no need to hold for reading or writing again. False: errno is set (EAGAIN past
// `deadline_ns`, EINTR).
bool AwaitFd(GuestThread& thread, int fd, short events, std::int64_t deadline_ns);

// True if calls on `fd` can wait for somebody else: sockets, pipes, terminals, event descriptors.
bool CanWait(int fd);

// The descriptor's SO_RCVTIMEO or SO_SNDTIMEO as a deadline from now.
std::int64_t SocketDeadline(GuestThread& thread, int fd, int option);

// True if a call that a handler interrupted is to be made again: every handler was installed with
// SA_RESTART.
bool RestartsAfterSignal();

}  // namespace tcs::preload
