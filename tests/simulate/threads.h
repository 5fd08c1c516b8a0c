// Threads and processes of a simulated machine, as its kernel keeps them.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <utility>

#include "coordinator/port/thread_signals.h"
#include "coordinator/port/traps.h"
#include "libtcs_preload/guest.h"
#include "tests/simulate/fiber.h"

namespace tcs::simulate {

class SimProgram;

// What threads share.
struct SimProcess {
  pid_t pid = 0;
  int notify_fd = -1;         // its end of its pipe; the link's own
  std::uint64_t pending = 0;  // signals for whichever of its threads takes them; bit 0 is signal 1
  std::int64_t sent_ns = 0;   // by the clock of who has sent the one that is pending
  int trap_listener = -1;     // an eventfd, readable while a call waits there
  preload::ProcessState state{preload::ProcessState::kAttached, false, {}, {}, {}};
};

struct SimThread {
  enum class State { kRuns, kAtWord, kInTrap, kInKernel, kDead };

  SimThread(pid_t its_tid, SimProcess& its_process, std::function<void()> body)
      : tid(its_tid), process(its_process), fiber(std::move(body)) {}

  bool Waits() const { return state != State::kRuns && state != State::kDead; }

  const pid_t tid;
  SimProcess& process;
  Fiber fiber;
  preload::GuestThread guest;  // while it is not entered
  State state = State::kRuns;
  int level = 0;
  std::int64_t ready_since = 0;  // its place in its level's queue: the least is the first
  bool is_dying = false;         // and is dead once it has the processor
  int idle_calls = 0;            // of the shim's, since its program has done something
  std::int64_t cpu_ns = 0;
  // Of that, what its program has computed, rather than the shim and the kernel for it.
  std::int64_t program_ns = 0;
  std::uint64_t blocked_signals = 0, pending = 0;  // bit 0 is signal 1
  TimerSignalRequest timer;                        // of its last timer's signal
  std::uint64_t dispatch = 0;                      // what the signal says that sends it to its gate
  std::int64_t waits = 0;                          // at words
  // What it waits for.
  const std::atomic<std::uint32_t>* word = nullptr;
  std::int64_t wakes_at_ns = INT64_MAX;
  TrappedCall call;
  bool call_is_taken = false;
  bool is_interrupted = false;    // its wait has ended for a signal
  long result = 0;                // of its wait
  SimProgram* program = nullptr;  // whose thread it is
  std::int64_t sends_ns = 0;      // by its clock, when it was about to send its last signal
  std::int64_t sent_ns = 0;       // that of the sender of the signal that is pending
};

}  // namespace tcs::simulate
