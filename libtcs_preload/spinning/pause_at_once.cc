// Compiled to use general registers only: pauses' entry keeps no others.
#include "libtcs_preload/spinning/pauses.h"
#include "shm/clock_page.h"
#include "shm/spin_streak.h"

using namespace tcs::preload;

int tcs_pause_at_once(std::uintptr_t site) {
  GuestThread* t = IfAttached();
  if (t == nullptr) {
    __builtin_ia32_pause();
    return 1;
  }
  tcs::shm::ThreadSlot& slot = *t->slot;
  if (slot.clock.counts_work != 0) return 0;
  const std::int64_t now_ns = tcs::shm::ReadClock(slot.clock).time_ns;
  const bool spins = tcs::shm::CountPause(slot.spin, static_cast<std::uint32_t>(site), now_ns,
                                          slot.clock.last_shown_ns.load(std::memory_order_relaxed),
                                          slot.spin_gap_ns);
  if (spins && now_ns >= slot.spin_until_ns) return 0;
  __builtin_ia32_pause();
  return 1;
}
