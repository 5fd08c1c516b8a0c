// The states of a thread, and which may follow which.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tcs {

enum class TaskState : std::uint8_t {
  kStarting,  // not attached yet                     -> kReady by its attach
  kReady,     // wants its virtual CPU                -> running, by dispatch
  kHolding,   // wants it once a time is safe         -> kReady by the progress of others
  kWaiting,   // for what its Wait says               -> kReady by that, or a signal
  kUnseen,  // blocked in a call the shim cannot see -> kReady once the kernel has it runnable again
  kDead,
};

// A thread that runs is kReady (or kStarting, as long as it has not attached): its requests make it
// kHolding or kWaiting, and the kernel may hold it (kUnseen). A thread that goes on from a wait may
// have to hold first. A wait gives way to another one only where the thread is about to die. A
// thread that the kernel held may be found at its gate, with what it asks for.
constexpr bool MayFollow(TaskState before, TaskState after) {
  constexpr std::size_t kStates = 6;
  constexpr bool kLegal[kStates][kStates] = {
      // to: starting, ready, holding, waiting, unseen, dead
      {true, true, true, true, true, true},        // from kStarting
      {false, true, true, true, true, true},       // kReady
      {false, true, false, true, false, true},     // kHolding
      {false, true, true, true, false, true},      // kWaiting
      {false, true, true, true, false, true},      // kUnseen
      {false, false, false, false, false, false},  // kDead
  };
  return kLegal[static_cast<std::size_t>(before)][static_cast<std::size_t>(after)];
}

}  // namespace tcs
