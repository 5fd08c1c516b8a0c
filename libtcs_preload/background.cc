// daemon and forkpty, on the shim's fork: the C library's own would fork where the shim does not
// see it, and the run would not know of the child.
#include <errno.h>
#include <fcntl.h>
#include <paths.h>
#include <pty.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>
#include <utmp.h>

#include "libtcs_preload/guest.h"

namespace {

// As the C library does it: nothing but the kernel's own null device will do.
bool ReplaceStreams() {
  const int fd = open(_PATH_DEVNULL, O_RDWR);
  if (fd < 0) return false;
  struct stat status {};
  const bool is_null =
      fstat(fd, &status) == 0 && S_ISCHR(status.st_mode) && status.st_rdev == makedev(1, 3);
  if (is_null) {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) dup2(fd, stream);
  } else {
    errno = ENODEV;
  }
  if (fd > STDERR_FILENO) close(fd);
  return is_null;
}

}  // namespace

TCS_EXPORT int daemon(int nochdir, int noclose) noexcept {
  const pid_t pid = fork();
  if (pid < 0) return -1;
  if (pid > 0) _exit(0);
  if (setsid() == -1) return -1;
  if (nochdir == 0 && chdir("/") != 0) return -1;
  return noclose != 0 || ReplaceStreams() ? 0 : -1;
}

TCS_EXPORT int forkpty(int* leader, char* name, const termios* mode, const winsize* size) noexcept {
  int follower = -1;
  if (openpty(leader, &follower, name, mode, size) != 0) return -1;
  const pid_t pid = fork();
  if (pid == 0) {
    close(*leader);
    if (login_tty(follower) != 0) _exit(1);
    return 0;
  }
  close(follower);
  if (pid < 0) close(*leader);
  return pid;
}
