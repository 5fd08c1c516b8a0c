#include "libtcs_preload/cycle_counter/virtual_counter.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

std::uint64_t tcs_counter_in_turn() {
  const Entered t;
  // No read was led here before the process had its coordinator: a thread that has none is being
  // made known to it.
  if (t == nullptr) return __rdtsc();
  return tcs::shm::CounterAt(NowNs(*t) + OffsetNs(Clock::kMonotonic),
                             g_header->counter_ticks_per_ns_q32);
}
