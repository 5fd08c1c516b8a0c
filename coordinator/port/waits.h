// How the coordinator sleeps, and wakes threads that wait in memory that it shares with them.
#pragma once

#include <sys/epoll.h>
#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "shm/time_kinds.h"

namespace tcs {

// A set of descriptors that the coordinator waits for, as epoll_create1 and epoll_ctl have it.
int MakeWaitSet();
bool ChangeWaitSet(int set, int operation, int fd, epoll_event* event);

// Waits until the set has events, which are put into `events`, and at most so long (negative:
// without limit). Returns how many there are. While the coordinator waits the programs' threads
// have the processor.
std::size_t WaitForEvents(int set, std::span<epoll_event> events, HostDuration timeout);

// Waits until there is something to read, or at most so long.
void AwaitReadable(int fd, HostDuration at_most);
// Whether there is something to read now: an event, of a set; or a pipe's other end is closed.
bool IsReadable(int fd);
// As read(2), of a pipe that does not wait.
ssize_t ReadPipe(int fd, void* to, std::size_t size);

// Sleeps for so long, whatever comes meanwhile.
void Pause(HostDuration duration);

// Wakes one of the threads that sleep in the kernel at the word.
void WakeAt(std::atomic<std::uint32_t>& word);

}  // namespace tcs
