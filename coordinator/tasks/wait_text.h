// A thread's wait, in words, for a user who sees nothing happen (standstill_watch.h).
#pragma once

#include <string>

#include "coordinator/tasks/task.h"

namespace tcs {

struct WaitText {
  // The wait of least rank among a program's threads is what the program waits for: a wait that
  // other threads of the same program can end comes last.
  int rank = 0;
  std::string text;  // goes on after the program's name

  auto operator<=>(const WaitText&) const = default;
};

// The wait of a thread that waits. `has_child`: as below. Looks at no other process.
WaitText TextOfAwaited(const Task& task, bool has_child);

// `has_child`: the thread's process has a child that lives. For the coordinator's thread; reads
// /proc.
WaitText TextOfWait(const Task& task, bool has_child);

}  // namespace tcs
