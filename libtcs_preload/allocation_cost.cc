// What libtcs_allocations.so (allocations/) calls for each allocation and each lock under fixed
// accounting.
#include "libtcs_preload/guest.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// An allocation stands for what a program computes until the next one, 2 us unless told; taking
// and releasing a lock is 20 ns of processor time natively.
constexpr std::int64_t kLocksPerAllocation = 100;
// So many locks in a row without anything that costs: it waits for others by looking again and
// again. The locks between a program's calls and allocations cost nothing; how many they are may
// depend on addresses.
constexpr int kSpins = 1000;

// Null where nothing is charged: by a thread that has not registered, and in the child of a fork
// before its first call. Never attaches.
GuestThread* Charged() {
  if (g_process->mode != ProcessState::kAttached) return nullptr;
  GuestThread& thread = t_thread;
  const bool is_charged =
      thread.slot != nullptr && !thread.attaching && thread.slot->clock.allocation_cost_ns != 0;
  return is_charged ? &thread : nullptr;
}

}  // namespace

// Both charge the calling thread, and let others have their turn where that takes it to its
// horizon. Async-signal-safe; errno stays.

TCS_EXPORT void tcs_charge_allocation() noexcept {
  GuestThread* thread = Charged();
  if (thread == nullptr) return;
  Charge(thread->slot->clock, thread->slot->clock.allocation_cost_ns);
  NowNs(*thread);
}

TCS_EXPORT void tcs_charge_lock() noexcept {
  GuestThread* thread = Charged();
  if (thread == nullptr) return;
  tcs::shm::ClockPage& page = thread->slot->clock;
  if (const std::int64_t now = tcs::shm::ReadClock(page).time_ns; now != thread->locks_at_ns) {
    thread->locks_at_ns = now;
    thread->locks = 0;
  }
  if (++thread->locks <= kSpins) return;
  Charge(page, page.allocation_cost_ns / kLocksPerAllocation);
  thread->locks_at_ns = NowNs(*thread);
}
