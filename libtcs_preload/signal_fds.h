// Descriptors of signalfd, whose readiness is that of the process that looks: the coordinator,
// which watches all other descriptors, does not see it, and waits for their signals instead.
#pragma once

namespace tcs::preload {

// The signals that `fd` stands for, or those in the epoll set that it is; 0 for all others. Costs
// nothing in processes without such descriptors.
unsigned long SignalsOf(int fd, bool* is_epoll);

// Has the kernel look again at those in an epoll set: when the coordinator looked, they did not
// seem ready, and the set has forgotten them.
void RearmSignalFds(int epfd);

}  // namespace tcs::preload
