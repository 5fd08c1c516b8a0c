#include "coordinator/tasks/run_clock.h"

#include <time.h>

#include "coordinator/port/clocks.h"
#include "shm/clock_page.h"

namespace tcs {

HostTime RunClock::Now() { return HostTime::FromNanoseconds(HostClockNs(CLOCK_MONOTONIC)); }

void RunClock::Calibrate() {
  rate_.ns_per_tick_q32 = CalibrateTsc();
  rate_.ticks_per_ns = 4294967296.0 / static_cast<double>(rate_.ns_per_tick_q32);
}

void RunClock::Start() {
  start_real_ns_ = HostClockNs(CLOCK_MONOTONIC);
  start_cpu_ns_ = HostClockNs(CLOCK_THREAD_CPUTIME_ID);
  start_tsc_ = HostTsc();
}

std::uint64_t RunClock::TicksIn(std::int64_t ns) const {
  return static_cast<std::uint64_t>(static_cast<double>(ns) * rate_.ticks_per_ns);
}

std::int64_t RunClock::NsAt(std::uint64_t tsc) const {
  return shm::MulQ32(static_cast<std::int64_t>(tsc - start_tsc_), rate_.ns_per_tick_q32);
}

std::int64_t RunClock::RealNs() const { return HostClockNs(CLOCK_MONOTONIC) - start_real_ns_; }

std::int64_t RunClock::CoordinatorNs() const {
  return HostClockNs(CLOCK_THREAD_CPUTIME_ID) - start_cpu_ns_;
}

}  // namespace tcs
