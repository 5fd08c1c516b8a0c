#include "coordinator/host/shared_cpu_meter.h"

#include <algorithm>
#include <atomic>

namespace tcs {

namespace {

constexpr HostDuration kLeastSleep = HostDuration::Microseconds(20),
                       kMostSleep = HostDuration::Microseconds(500);

}  // namespace

std::uint64_t SharedCpuMeter::Begin(MeteredThread& thread, std::uint64_t tsc, bool, bool) {
  thread.least_sleep = kLeastSleep;
  // So the thread asks at its first look, wherever it comes from.
  thread.page->last_check_tsc.store(0, std::memory_order_relaxed);
  return tsc;
}

HostDuration SharedCpuMeter::TimeToLook(MeteredThread& thread, std::uint64_t tsc,
                                        ProgramTime horizon) {
  thread.asked = std::max(MeasuredMeter::TimeToLook(thread, tsc, horizon), thread.least_sleep);
  return thread.asked;
}

Meter::Found SharedCpuMeter::Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
                                  const CpuClock& clock) {
  const std::int64_t before_ns = thread.known_cpu_ns;
  Check(thread, tsc, clock);
  const bool others_had_it =
      static_cast<double>(thread.known_cpu_ns - before_ns) < NsBetween(thread.asked_tsc, tsc) / 2;
  thread.least_sleep = others_had_it ? std::min(thread.least_sleep * 2, kMostSleep) : kLeastSleep;
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
