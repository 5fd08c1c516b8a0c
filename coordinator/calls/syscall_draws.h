// Random numbers that programs draw by trapped calls: raw, or by the C library's streams. Under
// fixed accounting they repeat, as those do that the shim sees (libtcs_preload/random.h).
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/remote_descriptor.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class SyscallDraws {
 public:
  explicit SyscallDraws(const RunState& run) : run_(run) {}

  // getrandom, which is trapped under fixed accounting only. Returns what the kernel would return.
  static std::int64_t GetRandom(Task& task, const TrappedCall& call);

  // Carries out a read or readv of `fd`, the descriptor of the call, if that is a file of random
  // numbers, and the run's draws repeat. The result is in task.trap_result. False: the read was not
  // carried out.
  bool Read(Task& task, const TrappedCall& call, const RemoteDescriptor& fd) const;

 private:
  const RunState& run_;
};

}  // namespace tcs
