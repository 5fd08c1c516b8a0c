// A child process that runs beside its parent, and is to end well.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include "tests/conformance/conformance.h"

namespace conformance {

// `child` runs in it, and it ends with 0 then.
template <class Child>
pid_t Start(Child child) {
  const pid_t pid = fork();
  if (pid == 0) {
    child();
    _exit(0);
  }
  EXPECT(pid > 0, "%s", strerror(errno));
  return pid;
}

inline void ExpectWell(pid_t pid) {
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "the other process: %#x", status);
}

}  // namespace conformance
