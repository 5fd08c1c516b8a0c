// What libtcs_allocations.so (allocations/) calls for each allocation and each lock under fixed
// accounting.
#include <algorithm>
#include <cstdint>

#include "libtcs_preload/guest.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// Natively an uncontended lock takes some 20 ns where planners allocate once in 2 us.
constexpr std::int64_t kLocksPerAllocation = 100;

// The calling thread's page; null where nothing is charged. Never attaches: a thread that has not
// registered, and the child of a fork before its first call, go on for nothing.
tcs::shm::ClockPage* Charged() {
  if (g_process->mode != ProcessState::kAttached) return nullptr;
  const GuestThread& thread = t_thread;
  if (thread.slot == nullptr || thread.attaching) return nullptr;
  tcs::shm::ClockPage& page = thread.slot->clock;
  return page.allocation_cost_ns == 0 ? nullptr : &page;
}

// Lets others have their turn where the cost takes the thread to its horizon.
void ChargeAndLook(tcs::shm::ClockPage& page, std::int64_t cost_ns) {
  Charge(page, cost_ns);
  NowNs(t_thread);
}

}  // namespace

// Async-signal-safe both; errno stays.
TCS_EXPORT void tcs_charge_allocation() noexcept {
  if (tcs::shm::ClockPage* page = Charged()) ChargeAndLook(*page, page->allocation_cost_ns);
}

TCS_EXPORT void tcs_charge_lock() noexcept {
  tcs::shm::ClockPage* page = Charged();
  if (page == nullptr) return;
  ChargeAndLook(*page, std::max<std::int64_t>(1, page->allocation_cost_ns / kLocksPerAllocation));
}
