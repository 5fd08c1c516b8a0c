// Descriptors of signalfd. Such a descriptor is ready when the process that looks has a signal. So
// the coordinator, which watches all other descriptors, does not see whether they are ready, and
// waits for their signals instead.
#pragma once

namespace tcs::preload {

// The signals of `fd`, or of the signalfds in the epoll set `fd`; 0 for all other descriptors.
// Costs nothing in processes without such descriptors.
unsigned long SignalsOf(int fd, bool* is_epoll);

// Has the kernel look again at the signalfds in an epoll set: when the coordinator looked, they did
// not seem ready, and the set has forgotten them.
void RearmSignalFds(int epfd);

}  // namespace tcs::preload
