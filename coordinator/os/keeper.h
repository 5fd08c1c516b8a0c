// The process between the guardian and the coordinator (guardian.h): it watches the coordinator,
// and ends whatever that one leaves behind.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "coordinator/os/guardian.h"

namespace tcs {

// Of the coordinator, should it be killed (guardian.h).
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

// In memory that the three processes share.
struct GuardedState {
  std::atomic<std::uint64_t> beats{0};  // of the coordinator
  std::atomic<bool> has_ended{false};   // it has, and the keeper says how
  std::atomic<int> clients_cpu{-1};     // of its clients; -1: there are none yet
  int pid_max = 0;
  // The coordinator writes one while the other one counts: it may be killed in the middle.
  Note notes[2];
  std::atomic<int> note{-1};  // which counts; -1: none
  Removal removals[256];
};

// In the keeper's process, which the guardian has just made with SIGCHLD, SIGTERM and SIGHUP
// blocked.
// Does not return: its end is the coordinator's.
[[noreturn]] void Keep(pid_t guardian, const GuardLimits& limits, GuardedState* state,
                       const std::function<int()>& coordinate);

// Ends all that the coordinator has left behind, and writes its note. `status`: how it has ended,
// as of waitpid.
void EndWhatIsLeft(int status, GuardedState* state);

// As the shell of a program that died of the signal would see it.
[[noreturn]] void DieOf(int signal_number);

}  // namespace tcs
