#include "coordinator/policy/wakeup_latency.h"

#include <algorithm>
#include <cmath>

#include "shm/check.h"
#include "shm/random_stream.h"

namespace tcs {

namespace {

constexpr double kP99 = 2.3263478740408408;  // of the standard normal distribution

}  // namespace

WakeupLatency::WakeupLatency(VirtualDuration median, VirtualDuration p99, std::uint64_t seed)
    : median_(median), most_(p99 * kMostTimesP99), seed_(seed) {
  TCS_CHECK(median > VirtualDuration() && p99 >= median);
  spread_ = std::log(static_cast<double>(p99.ns()) / static_cast<double>(median.ns())) / kP99;
}

VirtualDuration WakeupLatency::Of(int thread, std::int64_t wakeup) const {
  if (spread_ == 0) return median_;  // which is nothing where there is none
  constexpr int kWakeups = 40;       // bits of their number
  const std::uint64_t number =
      static_cast<std::uint64_t>(thread) << kWakeups ^ static_cast<std::uint64_t>(wakeup);
  RandomStream random(seed_, RandomPurpose::kWakeup, number);
  const double ns = static_cast<double>(median_.ns()) * std::exp(spread_ * random.Normal());
  return VirtualNs(std::llround(std::min(ns, static_cast<double>(most_.ns()))));
}

}  // namespace tcs
