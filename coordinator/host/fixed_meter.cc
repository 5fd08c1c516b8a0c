#include "coordinator/host/fixed_meter.h"

#include <utility>

namespace tcs {

void FixedMeter::SetRates(const MeteredThread& thread, const SetCosts& costs,
                          ClockGrant& grant) const {
  grant.ns_per_host_ns_q32 = thread.NsPerHostNsQ32();
  grant.ns_per_tick_q32 = 0;
  grant.check_after_ticks = ~std::uint64_t{0};
  grant.call_cost_ns = costs.call.ns();
  grant.allocation_cost_ns = costs.allocation.ns();
}

std::uint64_t FixedMeter::Begin(MeteredThread& thread, std::uint64_t tsc, bool, bool is_silent) {
  thread.silent_at = OwnTime(shm::ReadClockAt(*thread.page, tsc).time_ns);
  thread.silent_looks = 0;
  thread.is_silent = is_silent;
  return tsc;
}

HostDuration FixedMeter::TimeToLook(MeteredThread& thread, std::uint64_t, ProgramTime) {
  return thread.is_silent ? kLookAtSilentEvery : kLookEvery;
}

// Calls and allocations move its clock, whether it comes to its horizon by them or not.
Meter::Found FixedMeter::Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime,
                              const CpuClock&) {
  const ProgramTime now = OwnTime(shm::ReadClockAt(*thread.page, tsc).time_ns);
  if (std::exchange(thread.silent_at, now) != now) {
    thread.is_silent = false;
    thread.silent_looks = 0;
    return Found::kGoesOn;
  }
  if (!thread.is_silent && ++thread.silent_looks < kSilentLooks) return Found::kGoesOn;
  thread.is_silent = true;
  return Found::kIsSilent;
}

// The shim charges the calls that it sees, whatever the C library calls for it.
void FixedMeter::ChargeCall(MeteredThread& thread, VirtualDuration cost) {
  const std::uint64_t word = thread.page->executed_adjust.load();
  thread.page->executed_adjust.store(shm::PackAdjust(word, shm::AdjustValue(word) + cost.ns()));
}

}  // namespace tcs
