#include "coordinator/os/cpu_stopwatch.h"

#include <time.h>
#include <x86intrin.h>

#include "coordinator/os/host.h"

namespace tcs {

namespace {

constexpr std::uint64_t kSampleEvery = 32;

}  // namespace

void CpuStopwatch::Begin() {
  sampling_ = spans_++ % kSampleEvery == 0;
  if (sampling_) begin_ns_ = HostClockNs(CLOCK_THREAD_CPUTIME_ID);
  begin_tsc_ = __rdtsc();
}

void CpuStopwatch::End() {
  const std::uint64_t ticks = __rdtsc() - begin_tsc_;
  ticks_ += ticks;
  if (!sampling_) return;
  sampled_ns_ += HostClockNs(CLOCK_THREAD_CPUTIME_ID) - begin_ns_;
  sampled_ticks_ += ticks;
}

std::int64_t CpuStopwatch::TotalNs() const {
  if (sampled_ticks_ == 0) return 0;
  return static_cast<std::int64_t>(static_cast<double>(ticks_) * static_cast<double>(sampled_ns_) /
                                   static_cast<double>(sampled_ticks_));
}

}  // namespace tcs
