// What libtcs_allocations.so (allocations/) calls for each allocation and each lock under fixed
// accounting.
#include "libtcs_preload/guest.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// An allocation stands for what a program computes until the next one, 2 us unless told; taking
// and releasing a lock is 20 ns of processor time natively.
constexpr std::int64_t kLocksPerAllocation = 100;

// Charges the calling thread, and lets others have their turn where that takes it to its horizon.
// Never attaches: a thread that has not registered, and the child of a fork before its first call,
// allocate for nothing. Async-signal-safe; errno stays.
void ChargeShare(std::int64_t divisor) {
  if (g_process->mode != ProcessState::kAttached) return;
  GuestThread& thread = t_thread;
  if (thread.slot == nullptr || thread.attaching) return;
  tcs::shm::ClockPage& page = thread.slot->clock;
  if (page.allocation_cost_ns == 0) return;
  Charge(page, page.allocation_cost_ns / divisor);
  NowNs(thread);
}

}  // namespace

TCS_EXPORT void tcs_charge_allocation() noexcept { ChargeShare(1); }

TCS_EXPORT void tcs_charge_lock() noexcept { ChargeShare(kLocksPerAllocation); }
