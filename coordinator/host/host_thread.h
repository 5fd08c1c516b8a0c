// A thread of a client, as the processor of the host sees it on which it runs.
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "coordinator/host/clock_grant.h"
#include "coordinator/host/meter.h"
#include "shm/layout.h"

namespace tcs {

struct HostThread {
  pid_t tid = 0;
  // Shared with it; null before it registers, and readable until the engine's next step.
  shm::ThreadSlot* slot_memory = nullptr;
  bool may_run = false;  // while the coordinator sleeps (active_threads.h)
  bool parked = true;    // at its gate, rather than stopped by priority
  ClockGrant grant;      // of its last dispatch
  std::uint64_t dispatches = 0;
  MeteredThread metered;
  bool is_ahead = false;  // it computes ahead, on another processor (further_cpu.h)
  // It lives on another processor, for turns beside the coordinator (beside_cpu.h), and has one.
  bool is_beside = false, turns_beside = false;

  // The word for the clock page that an adjustment of nothing in its last dispatch has.
  std::uint64_t DispatchWord() const { return dispatches << shm::kAdjustBits; }
  // Its clock is the one that it was given, with what it has added in its last dispatch.
  bool HasOwnClock() const { return IsOwn(slot_memory->clock); }
  bool IsOwn(const shm::ClockPage& page) const;
};

}  // namespace tcs
