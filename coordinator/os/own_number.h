// How threads and processes know themselves where they live in a PID namespace of their own, as
// sandboxes and launchers make them: by other numbers than tcsim knows them by.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace tcs {

struct OwnNumber {
  pid_t number = 0;
  std::uint64_t pid_namespace = 0;  // 0: tcsim's, where the number is the same
};

// Of a thread, by tcsim's number of it. What the kernel does not tell is taken to be the same.
OwnNumber OwnNumberOf(pid_t tid);

// The thread of that process, or its child, that has that number there; 0: none.
pid_t ThreadByOwnNumber(pid_t pid, pid_t number);
pid_t ChildByOwnNumber(pid_t pid, pid_t number);

}  // namespace tcs
