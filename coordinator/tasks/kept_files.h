// The files that a thread's call was made on, when its wait is over. Linux keeps them for the call,
// whatever becomes of their numbers meanwhile (calls/call_files.h).
#pragma once

#include <cstdint>
#include <vector>

#include "coordinator/port/unique_fd.h"
#include "shm/layout.h"
#include "shm/time_kinds.h"

namespace tcs {

// Counts of the turns that may have changed the meaning of a process's descriptors.
struct DescriptorChanges {
  std::uint64_t turns = 0;     // of its threads,
  std::uint64_t by_calls = 0;  // and of these, turns in which they have closed or replaced some, by
                               // calls that the shim has seen

  bool operator==(const DescriptorChanges&) const = default;
};

struct KeptFiles {
  std::vector<UniqueFd> files;     // copies of the client's,
  std::vector<shm::WaitFd> asked;  // by which numbers, and for what, each was asked for
  shm::KeepFiles keep = shm::KeepFiles::kNot;
  std::uint64_t signals = 0;  // these signals ended the wait, too
  DescriptorChanges since;    // of the process's when the wait began
  // Of a wait in a trapped call: the wait's deadline; whether the call is to take or give data, and
  // how much of that is done.
  bool is_raw = false;
  VirtualTime deadline = VirtualTime::Never();
  bool transfers = false;
  std::int64_t done = 0;
  // Which numbers mean another file by now, or none. Empty before that is looked for; where all
  // numbers mean what they meant, nothing is kept.
  std::vector<bool> are_replaced;

  bool IsNeeded() const { return !are_replaced.empty(); }
};

}  // namespace tcs
