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

void SharedCpuMeter::End(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) {
  Check(thread, tsc, clock);
}

}  // namespace tcs
