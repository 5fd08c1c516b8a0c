// The timer descriptors of clients. They are the kernel's own timerfds, so that every call on them
// does what it does natively; but the kernel's timer in them never runs. The coordinator keeps the
// time, and says how often they have run out.
//
// The descriptors are copies of clients', who may do to them whatever they like. Nothing here
// waits.
#pragma once

#include <cstdint>

namespace tcs {

// Whether the descriptor is a timer descriptor, whatever its client says.
bool IsTimerDescriptor(int fd);

// Whether the descriptor was made for one of the clocks that can be set.
bool IsOfRealtime(int timer_fd);

// Adds so many expirations, to be read. False if the kernel does not take them.
bool AddExpirations(int timer_fd, std::int64_t count);

// From now on no expirations are to be read, and the kernel's own timer does not run.
void ForgetExpirations(int timer_fd);

}  // namespace tcs
