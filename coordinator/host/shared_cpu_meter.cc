#include "coordinator/host/shared_cpu_meter.h"

#include <atomic>

namespace tcs {

std::uint64_t SharedCpuMeter::Begin(MeteredThread& thread, std::uint64_t tsc, bool, bool) {
  // So the thread asks at its first look, wherever it comes from.
  thread.page->last_check_tsc.store(0, std::memory_order_relaxed);
  return tsc;
}

Meter::Found SharedCpuMeter::Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
                                  const CpuClock& clock) {
  Check(thread, tsc, clock);
  return MeasuredMeter::Look(thread, tsc, horizon, clock);
}

void SharedCpuMeter::Check(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) {
  MeasuredMeter::Check(thread, tsc, [&] {
    const std::int64_t now_ns = clock();
    if (now_ns >= 0) thread.known_cpu_ns = now_ns;
    return thread.known_cpu_ns;
  });
}

void SharedCpuMeter::End(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) {
  Check(thread, tsc, clock);
}

}  // namespace tcs
