// How the coordinator sleeps, and wakes threads that wait in memory that it shares with them.
#pragma once

#include <sys/epoll.h>

#include <atomic>
#include <cstdint>
#include <span>

#include "shm/time_kinds.h"

namespace tcs {

// Waits until the epoll set has events, which are put into `events`, and at most so long (negative:
// without limit). Returns how many there are. While the coordinator waits the programs' threads
// have the processor.
std::size_t WaitForEvents(int epoll, std::span<epoll_event> events, HostDuration timeout);

// Waits until there is something to read, or at most so long.
void AwaitReadable(int fd, HostDuration at_most);

// Sleeps for so long, whatever comes meanwhile.
void Pause(HostDuration duration);

// Wakes one of the threads that sleep in the kernel at the word.
void WakeAt(std::atomic<std::uint32_t>& word);

}  // namespace tcs
