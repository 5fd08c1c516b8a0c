// The process between the guardian and the coordinator (guardian.h): the keeper watches the
// coordinator, and ends whatever the coordinator leaves behind.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "coordinator/os/guardian.h"

namespace tcs {

// A note of the coordinator, should the coordinator be killed (guardian.h).
struct Note {
  static constexpr std::size_t kMostPath = 4096, kMostText = 1 << 20;
  char path[kMostPath];
  std::size_t size;
  char text[kMostText];
};

// A file or folder that must not outlive the run (guardian.h).
struct Removal {
  static constexpr std::size_t kMostPath = 256;
  std::atomic<bool> is_set{false};
  char path[kMostPath];
};

// The state in memory that the three processes share.
struct GuardedState {
  std::atomic<std::uint64_t> beats{0};  // of the coordinator
  std::atomic<bool> has_ended{false};   // the coordinator has, and the keeper says how
  std::atomic<int> clients_cpu{-1};     // of the clients; -1: there are none yet
  int pid_max = 0;
  // The coordinator writes one note while the other one counts: the coordinator may be killed in
  // the middle.
  Note notes[2];
  std::atomic<int> note{-1};  // which of the two counts; -1: none
  Removal removals[256];
};

// Runs in the keeper's process, which the guardian has just made with SIGCHLD, SIGTERM and SIGHUP
// blocked. Does not return: the keeper's end is the coordinator's.
[[noreturn]] void Keep(pid_t guardian, const GuardLimits& limits, GuardedState* state,
                       const std::function<int()>& coordinate);

// Ends all that the coordinator has left behind, and writes its note. `status`: how the caller's
// child has ended, as of waitpid.
void EndWhatIsLeft(int status, GuardedState* state);

// Ends this process so that a shell sees a program that died of the signal.
[[noreturn]] void DieOf(int signal_number);

}  // namespace tcs
