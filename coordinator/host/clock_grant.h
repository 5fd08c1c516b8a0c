// The values that the coordinator has written into a thread's clock page: how the thread's clock
// runs, and how far it can come by itself. The page is shared with the thread's process, which may
// overwrite it; this is the coordinator's own copy.
#pragma once

#include <cstdint>

#include "shm/layout.h"

namespace tcs {

struct ClockGrant {
  std::int64_t base_time_ns = 0, base_cpu_ns = 0;
  std::uint64_t base_tsc = 0, ns_per_tick_q32 = 0;
  std::int64_t horizon_ns = 0, idle_until_ns = 0, read_safe_ns = 0, write_safe_ns = 0;
  std::int64_t local_read_safe_ns = 0;
  std::uint64_t ns_per_host_ns_q32 = 0, check_after_ticks = 0;
  std::int64_t call_cost_ns = 0, allocation_cost_ns = 0;
  std::uint32_t counts_work = 0;
  std::int64_t most_idle_ns = 0;   // of this dispatch
  std::int64_t most_shown_ns = 0;  // of all dispatches
  std::int64_t most_stale_ns = 0;  // of all

  // Copies the fields that are the coordinator's.
  void WriteTo(shm::ClockPage& page) const;
  // False if one of these fields has another value by now.
  bool StandsIn(const shm::ClockPage& page) const;
  // May be called again with other limits in the same dispatch.
  void NoteLimits();
};

}  // namespace tcs
