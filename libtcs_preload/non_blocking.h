// Answers that the kernel gives without waiting, though a descriptor is not ready: nothing was
// asked for, or something is wrong. Only the kernel knows all of that, so the kernel is asked, in a
// form of the call that does not wait. -EAGAIN: the call would wait.
#pragma once

#include <sys/socket.h>
#include <sys/uio.h>

namespace tcs::preload {

// The kernel has no form of the call that cannot wait. The value is no result of a call.
inline constexpr long kNoForm = -4096;

// read and readv. A `count` below 0 or too large is asked for like any other. -EOPNOTSUPP: the
// descriptor has no such form, as terminals and some others; but it can be read.
long TryRead(int fd, const iovec* iov, int count);
// The error of such a read, or -EAGAIN.
long TryReadWithoutForm(int fd, const iovec* iov, int count);

// True if accept4 would wait for a connection.
bool AcceptWaits(int fd, int flags);

// The socket's reads wait for more than the first byte (SO_RCVLOWAT): data that is there already is
// no answer.
bool WantsMore(int fd);

// False if no sender to the socket waits until a read makes room: with UDP, a datagram that does
// not fit is lost.
bool ReadingMakesRoom(int fd);

// True if a call with such flags never waits for data.
bool ReceivesAtOnce(int fd, int flags);

}  // namespace tcs::preload
