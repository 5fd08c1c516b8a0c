// What libtcs_allocations.so (allocations/) calls for each allocation under fixed accounting.
#include "libtcs_preload/guest.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

// Charges the calling thread, and lets others have their turn where that takes it to its horizon.
// Never attaches: a thread that has not registered, and the child of a fork before its first call,
// allocate for nothing. Async-signal-safe; errno stays.
TCS_EXPORT void tcs_charge_allocation() noexcept {
  if (g_process->mode != ProcessState::kAttached) return;
  GuestThread& thread = t_thread;
  if (thread.slot == nullptr || thread.attaching) return;
  tcs::shm::ClockPage& page = thread.slot->clock;
  if (page.allocation_cost_ns == 0) return;
  Charge(page, page.allocation_cost_ns);
  NowNs(thread);
}
