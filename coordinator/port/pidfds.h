// Processes and their descriptors, by descriptors.
#pragma once

#include <sys/types.h>

namespace tcs {

int OpenPidfd(pid_t pid);
// By SIGKILL. The kernel does what is then left to do of the process's end.
void KillByPidfd(int pidfd);
// A copy of another process's descriptor: pidfd_getfd. -1: errno is set.
int DuplicateFd(int pidfd, int fd);
// The errno by which the kernel refuses pidfd_getfd to this process, whoever is asked about, as a
// container's seccomp profile does; 0 if it does not.
int WhyNoDuplicates();

}  // namespace tcs
