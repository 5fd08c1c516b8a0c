// Compiled to use general registers only: entries.cc keeps no others.
#include "libtcs_preload/cycle_counter/virtual_counter.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

std::uint64_t tcs_counter_at_once() {
  GuestThread* t = IfAttached();
  if (t == nullptr || t->slot->clock.counts_work != 0) return 0;
  tcs::shm::ClockPage& page = t->slot->clock;
  const tcs::shm::ClockReading reading = tcs::shm::ReadClock(page);
  if (reading.time_ns >= reading.horizon_ns || tcs::shm::IsCheckDue(page, reading)) return 0;
  const Now now = Show(page, reading);
  if (now.shown_ns >= reading.horizon_ns) return 0;
  return tcs::shm::CounterAt(now.shown_ns + OffsetNs(Clock::kMonotonic),
                             g_header->counter_ticks_per_ns_q32);
}

std::uint32_t tcs_counter_processor() {
  const GuestThread* t = IfAttached();
  return t == nullptr ? 0 : t->slot->core;
}
