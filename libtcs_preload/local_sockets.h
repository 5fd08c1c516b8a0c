// Sockets that only programs of the own robot send to (shm/local_sockets.h). Async-signal-safe.
#pragma once

#include <poll.h>
#include <sys/socket.h>

#include <cstdint>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

// What was sent before these times is there: from anybody, and from programs of the own robot.
struct SafeTimes {
  std::int64_t of_all, of_robot;
};
inline SafeTimes SafeTimesOf(const GuestThread& thread) {
  const shm::ClockPage& page = thread.slot->clock;
  return {page.read_safe_ns, page.local_read_safe_ns};
}

// A look at the descriptor at `now_ns` by the thread's clock has missed nothing, though others have
// not come as far. `safe` is from before the look: between the look and this call the thread may
// have been stopped, and others may have sent and come further. Makes a system call.
bool IsSafeLook(const GuestThread& thread, int fd, std::int64_t now_ns, const SafeTimes& safe);
// Whether looks at several descriptors that are made after this call will miss nothing; false if
// there are too many to look at.
bool AreSafeLooks(const GuestThread& thread, const pollfd* fds, unsigned long count,
                  std::int64_t now_ns);

// Called before the written data goes to that address (null: to where the socket is connected).
// True if the thread need not hold for the write any more: only its own robot's programs receive
// the data, none of which can look at an earlier time; or programs of another robot do, to which
// sockets were local so far, and the thread has held.
bool ReachesSafely(GuestThread& thread, const void* address, socklen_t size);
// As above, for a message, which may carry descriptors that leave the robot.
bool ReachesSafely(GuestThread& thread, const msghdr& message);

}  // namespace tcs::preload
