// A thread of a client, as seen by the processor of the host on which the thread runs.
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "coordinator/host/clock_grant.h"
#include "coordinator/host/meter.h"
#include "shm/layout.h"

namespace tcs {

struct HostThread {
  pid_t tid = 0;
  // Shared with the thread; null before the thread registers, and readable until the engine's next
  // step.
  shm::ThreadSlot* slot_memory = nullptr;
  bool may_run = false;  // while the coordinator sleeps (active_threads.h)
  bool parked = true;    // at its gate, rather than stopped by priority
  ClockGrant grant;      // of its last dispatch
  std::uint64_t dispatches = 0;
  MeteredThread metered;
  bool is_ahead = false;  // the thread computes ahead, on another processor (further_cpu.h)
  // The thread lives on another processor, for turns beside the coordinator (beside_cpu.h); and it
  // has such a turn.
  bool is_beside = false, turns_beside = false;

  // The word on the clock page that stands for an adjustment of nothing in the thread's last
  // dispatch.
  std::uint64_t DispatchWord() const { return dispatches << shm::kAdjustBits; }
  // True if the thread's clock is the one that it was given, with what the thread has added in its
  // last dispatch.
  bool HasOwnClock() const { return IsOwn(slot_memory->clock); }
  bool IsOwn(const shm::ClockPage& page) const;
};

}  // namespace tcs
