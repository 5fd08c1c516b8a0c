// The numbers by which threads and processes know themselves in a PID namespace of their own, as
// sandboxes and launchers make them. tcsim knows these threads and processes by other numbers.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace tcs {

struct OwnNumber {
  pid_t number = 0;
  std::uint64_t pid_namespace = 0;  // 0: tcsim's, where the number is the same
};

// The number of a thread for itself, by tcsim's number of it. A number that the kernel does not
// tell is taken to be the same.
OwnNumber OwnNumberOf(pid_t tid);

// The thread or the child of process `pid` that has `number` in its own namespace; 0: there is
// none.
pid_t ThreadByOwnNumber(pid_t pid, pid_t number);
pid_t ChildByOwnNumber(pid_t pid, pid_t number);

}  // namespace tcs
