// The functions that libtcs_allocations.so (allocations/) calls for each allocation and each lock,
// where these are counted or have a set cost.
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/set_costs.h"

using namespace tcs::preload;

namespace {

using tcs::shm::ClockPage;
using tcs::shm::WorkCounts;

constexpr std::int64_t kLocksPerAllocation = WorkCounts::kLocksPerAllocation;
// A thread that takes so many locks in a row without anything that costs waits for others by
// looking again and again. The locks between a program's calls and allocations cost nothing; how
// many they are may depend on addresses.
constexpr int kSpins = 1000;

// Null where nothing is counted: in a thread that has not registered, and in the child of a fork
// before its first call. Never attaches.
GuestThread* Counted() {
  if (g_process->mode != ProcessState::kAttached) return nullptr;
  GuestThread& thread = OwnState();
  const bool is_counted =
      thread.slot != nullptr && !thread.attaching && thread.slot->clock.counts_work != 0;
  return is_counted ? &thread : nullptr;
}

// Ends the thread's last call: what the call did to others happened before the thread's clock moves
// on, where only gates hold the thread.
void EndLastCall(GuestThread& thread) {
  if (g_header->is_unprivileged == 0 || (!thread.in_call && IsDispatched(thread))) return;
  AwaitTurn(thread);
  thread.in_call = false;
}

// A value that moves with everything that costs: time itself, where nothing else moves it.
std::int64_t WhatHasCost(const tcs::shm::ThreadSlot& slot) {
  if (g_header->accounting == tcs::shm::Accounting::kFixed) {
    return tcs::shm::ReadClock(slot.clock).time_ns;
  }
  return static_cast<std::int64_t>(slot.work.calls + slot.work.locks);
}

}  // namespace

// Both functions count what the calling thread does. Where that has a set cost they charge the
// thread, and let others have their turn if the charge takes the thread to its horizon.
// Async-signal-safe; errno stays.

TCS_EXPORT void tcs_charge_allocation() noexcept {
  GuestThread* thread = Counted();
  if (thread == nullptr) return;
  thread->slot->work.locks += WorkCounts::kLocksPerAllocation;
  ClockPage& page = thread->slot->clock;
  if (page.allocation_cost_ns == 0) return;
  EndLastCall(*thread);
  std::uint32_t& number = thread->slot->receipts.allocations;
  if (number <= tcs::shm::kShortAllocations) ++number;
  Charge(page, tcs::shm::AllocationCostNs(page.allocation_cost_ns, number));
  NowNs(*thread);
}

TCS_EXPORT void tcs_charge_lock() noexcept {
  GuestThread* thread = Counted();
  if (thread == nullptr) return;
  if (const std::int64_t at = WhatHasCost(*thread->slot); at != thread->locks_at) {
    thread->locks_at = at;
    thread->locks = 0;
  }
  if (++thread->locks <= kSpins) return;
  ++thread->slot->work.locks;
  ClockPage& page = thread->slot->clock;
  if (page.allocation_cost_ns == 0) {
    thread->locks_at = WhatHasCost(*thread->slot);
    return;
  }
  EndLastCall(*thread);
  Charge(page, tcs::shm::LockCostNs(page.allocation_cost_ns, kLocksPerAllocation));
  thread->locks_at = NowNs(*thread);
}
