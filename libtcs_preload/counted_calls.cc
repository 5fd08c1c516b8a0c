// The cost of a call where calls have a set cost, and the wait of a call for its thread's turn
// where it has to wait.
#include <utility>

#include "libtcs_preload/descriptor_broker.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/clock_page.h"

namespace tcs::preload {

void Charge(shm::ClockPage& page, std::int64_t cost_ns) {
  std::uint64_t word = page.executed_adjust.load(std::memory_order_relaxed);
  while (!page.executed_adjust.compare_exchange_weak(
      word, shm::PackAdjust(word, shm::AdjustValue(word) + cost_ns))) {
  }
}

namespace {

// True once in a dispatch.
bool BeganInUnseenCall(GuestThread& thread) {
  const shm::ClockPage& page = thread.slot->clock;
  if ((page.counts_work & shm::kBeginsInCall) == 0) return false;
  const std::uint64_t dispatch = shm::DispatchNumber(page.executed_adjust.load());
  return std::exchange(thread.told_dispatch, dispatch) != dispatch;
}

}  // namespace

void CountCall(GuestThread& thread, Concern concern) {
  if (g_header->is_unprivileged != 0) {
    KeepBroker();
    const bool is_fixed = g_header->accounting == shm::Accounting::kFixed;
    const bool has_to_wait = is_fixed && (concern == Concern::kOthers || !IsDispatched(thread));
    if (has_to_wait || thread.in_call || IsAtGate(thread) || BeganInUnseenCall(thread)) {
      AwaitTurn(thread);
    }
    thread.in_call = is_fixed && concern == Concern::kOthers;
  } else if ((thread.slot->clock.counts_work & shm::kIsAhead) != 0 && !IsAtGate(thread)) {
    AwaitTurn(thread);
  }
  ++thread.slot->work.calls;
  shm::ClockPage& page = thread.slot->clock;
  if (page.call_cost_ns == 0) return;
  Charge(page, page.call_cost_ns);
  // The clock is read here and not at the next look at a clock, which may be at the same place of a
  // loop each time.
  NowNs(thread);
}

}  // namespace tcs::preload
