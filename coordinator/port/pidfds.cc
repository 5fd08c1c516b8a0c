#include "coordinator/port/pidfds.h"

#include <errno.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "coordinator/port/unique_fd.h"

namespace tcs {

int OpenPidfd(pid_t pid) { return static_cast<int>(syscall(SYS_pidfd_open, pid, 0)); }

void KillByPidfd(int pidfd) { syscall(SYS_pidfd_send_signal, pidfd, SIGKILL, nullptr, 0); }

int DuplicateFd(int pidfd, int fd) {
  return static_cast<int>(syscall(SYS_pidfd_getfd, pidfd, fd, 0));
}

int WhyNoDuplicates() {
  const UniqueFd own(OpenPidfd(getpid()));
  const UniqueFd copy(own ? DuplicateFd(own.get(), own.get()) : -1);
  return copy ? 0 : errno;
}

}  // namespace tcs
