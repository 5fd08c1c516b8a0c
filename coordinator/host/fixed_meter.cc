#include "coordinator/host/fixed_meter.h"

#include <algorithm>
#include <utility>

#include "shm/set_costs.h"

namespace tcs {

namespace {

// The timer and the thread's CPU clock do not agree more closely than this.
constexpr HostDuration kLeastLook = HostDuration::Microseconds(50);

void Charge(shm::ClockPage& page, VirtualDuration cost) {
  std::uint64_t word = page.executed_adjust.load();
  // Where nothing but its gate stops the thread, it may charge itself meanwhile.
  while (!page.executed_adjust.compare_exchange_weak(
      word, shm::PackAdjust(word, shm::AdjustValue(word) + cost.ns()))) {
  }
}

// Every charge since the last look at the thread is for calls and allocations: such a charge breaks
// the silence, whether it takes the thread to its horizon or not. Sleeping costs a call, too.
bool HasMadeCalls(MeteredThread& thread, const shm::ClockReading& now) {
  return std::exchange(thread.silent_cpu_ns, now.cpu_ns) != now.cpu_ns;
}

}  // namespace

void FixedMeter::SetRates(const MeteredThread& thread, const SetCosts& costs,
                          ClockGrant& grant) const {
  grant.ns_per_host_ns_q32 = thread.NsPerHostNsQ32();
  grant.ns_per_tick_q32 = 0;
  grant.check_after_ticks = ~std::uint64_t{0};
  grant.call_cost_ns = costs.call.ns();
  grant.allocation_cost_ns =
      costs.allocation.has_value() ? costs.allocation->ns() : shm::kUsualAllocationCost;
}

std::uint64_t FixedMeter::Begin(MeteredThread& thread, std::uint64_t tsc, bool, bool) {
  thread.next_look = kLookAtSilentEvery;
  if (HasMadeCalls(thread, shm::ReadClockAt(*thread.page, tsc))) thread.silent_from_ns = -1;
  return tsc;
}

HostDuration FixedMeter::TimeToLook(MeteredThread& thread, std::uint64_t, ProgramTime) {
  return thread.pays_for_silence ? thread.next_look : kLookEvery;
}

Meter::Found FixedMeter::Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
                              const CpuClock& clock) {
  const shm::ClockReading now = shm::ReadClockAt(*thread.page, tsc);
  const std::int64_t cpu_ns = clock();
  if (HasMadeCalls(thread, now)) thread.silent_from_ns = -1;
  if (thread.silent_from_ns < 0) thread.silent_from_ns = cpu_ns;
  if (thread.pays_for_silence) return LookAtSilent(thread, now, horizon, cpu_ns);
  const HostDuration silent = HostNs(cpu_ns - thread.silent_from_ns);
  return silent < silent_after_ ? Found::kGoesOn : Found::kIsSilent;
}

Meter::Found FixedMeter::LookAtSilent(MeteredThread& thread, const shm::ClockReading& now,
                                      ProgramTime horizon, std::int64_t cpu_ns) {
  HostDuration silent = HostNs(cpu_ns - thread.silent_from_ns);
  const bool is_charged = silent >= kLookAtSilentEvery;
  if (is_charged) {
    Charge(*thread.page, kSilentCost);
    thread.silent_cpu_ns += kSilentCost.ns();
    silent -= kLookAtSilentEvery;
    // The thread ran for longer while the coordinator did not look: no thread is charged that time.
    if (silent >= kLookAtSilentEvery) silent = {};
    thread.silent_from_ns = cpu_ns - silent.ns();
  }
  thread.next_look = std::max(kLookAtSilentEvery - silent, kLeastLook);
  const VirtualDuration cost = is_charged ? kSilentCost : VirtualDuration();
  return OwnTime(now.time_ns) + cost >= horizon ? Found::kAtHorizon : Found::kGoesOn;
}

// The shim charges the calls that it sees, whatever the C library calls for it.
void FixedMeter::ChargeCall(MeteredThread& thread, VirtualDuration cost) {
  Charge(*thread.page, cost);
}

}  // namespace tcs
