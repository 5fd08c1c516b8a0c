// The arguments of a trapped call that makes a thread or a process: clone, clone3, fork, vfork.
#pragma once

#include <sched.h>

#include <cstdint>
#include <optional>

#include "coordinator/port/traps.h"

namespace tcs {

struct CloneCall {
  std::uint64_t flags = 0;
  std::uint64_t tid_address = 0;  // where the kernel writes the number of the new task; 0: nowhere
  std::uint64_t end_word = 0;     // a word that the kernel clears at the new task's end; 0: none
  std::uint64_t tls = 0;          // pthread_t, of a thread of the C library's

  bool MakesThread() const { return (flags & CLONE_THREAD) != 0; }
  bool SharesMemory() const { return (flags & CLONE_VM) != 0; }
  // The caller stands in the kernel until the child has executed another program, or has ended.
  bool WaitsForChild() const { return (flags & CLONE_VFORK) != 0; }
  // The new task has thread-local storage of its own: the contents are not its maker's.
  bool HasOwnStorage() const { return !SharesMemory() || (flags & CLONE_SETTLS) != 0; }
};

// Nothing: the call is another one, or its arguments cannot be read.
std::optional<CloneCall> ReadCloneCall(const TrappedCall& call);

}  // namespace tcs
