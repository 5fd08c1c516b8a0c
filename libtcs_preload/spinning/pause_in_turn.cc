#include "libtcs_preload/exchange.h"
#include "libtcs_preload/spinning/pauses.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/set_costs.h"
#include "shm/spin_streak.h"

using namespace tcs::preload;

namespace tcs::preload {

namespace {

std::int64_t ShownBy(const shm::ThreadSlot& slot) {
  return slot.clock.last_shown_ns.load(std::memory_order_relaxed);
}

// A thread that yields does more in between: it looks for work, say.
constexpr std::int64_t kYieldGaps = 10;

bool Spins(shm::ThreadSlot& slot, std::uintptr_t site, std::int64_t now_ns, std::int64_t shown_ns,
           std::int64_t gap_ns) {
  return shm::CountPause(slot.spin, static_cast<std::uint32_t>(site), now_ns, shown_ns, gap_ns);
}

std::int64_t TimeOf(const shm::ThreadSlot& slot) { return shm::ReadClock(slot.clock).time_ns; }

// The thread goes on spinning; its turn may have ended.
void GoOn(shm::ThreadSlot& slot) { shm::GoOnSpinning(slot.spin, TimeOf(slot), ShownBy(slot)); }

}  // namespace

void YieldCounted(GuestThread& thread, std::uintptr_t site) {
  shm::ThreadSlot& slot = *thread.slot;
  const bool spins = Spins(slot, site, TimeOf(slot) - slot.clock.call_cost_ns, ShownBy(slot),
                           kYieldGaps * slot.spin_gap_ns);
  Exchange(thread, Request{.kind = shm::NotificationKind::kYield, .args = {spins ? 1 : 0}});
  if (spins) return GoOn(slot);
  slot.spin.last_ns = TimeOf(slot);
  slot.spin.shown_ns = ShownBy(slot);
}

}  // namespace tcs::preload

void tcs_pause_in_turn(std::uintptr_t site) {
  GuestThread* t = IfAttached();
  if (t == nullptr || IsAtGate(*t)) {
    __builtin_ia32_pause();
    return;
  }
  tcs::shm::ThreadSlot& slot = *t->slot;
  // The time that the program's own looks at its clock have shown, and not the look here.
  const std::int64_t shown_ns = ShownBy(slot);
  if (g_header->accounting == tcs::shm::Accounting::kFixed) {
    Charge(slot.clock, tcs::shm::kPauseNs);
    NowNs(*t);  // the thread may have come to its horizon
  }
  const bool spins = Spins(slot, site, TimeOf(slot), shown_ns, slot.spin_gap_ns);
  slot.spin.shown_ns = ShownBy(slot);
  if (!spins || slot.spin.last_ns < slot.spin_until_ns) {
    __builtin_ia32_pause();
    return;
  }
  const Entered entered;
  if (entered == nullptr) return;
  Exchange(*entered, Request{.kind = tcs::shm::NotificationKind::kSpins});
  GoOn(slot);
}
