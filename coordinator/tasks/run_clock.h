// The host's time since a run began: the time that has passed, the coordinator's part of it, and
// the TSC that both the coordinator and the clients' clocks are read by. Nothing virtual is here.
//
// For the coordinator's thread only. Real nanoseconds.
#pragma once

#include <cstdint>

#include "coordinator/host/meter.h"

namespace tcs {

class RunClock {
 public:
  // CLOCK_MONOTONIC.
  static HostTime Now();

  // Measures the TSC, which may take a moment: once, before the run.
  void Calibrate();
  // The run begins now.
  void Start();

  const TscRate& rate() const { return rate_; }
  std::uint64_t TicksIn(std::int64_t ns) const;

  std::uint64_t start_tsc() const { return start_tsc_; }
  // Since the start. The first is also right before Calibrate, and 0 then.
  std::int64_t NsAt(std::uint64_t tsc) const;
  std::int64_t RealNs() const;
  // Of that, the coordinator's own processor time.
  std::int64_t CoordinatorNs() const;

 private:
  TscRate rate_{.ns_per_tick_q32 = 0};
  std::uint64_t start_tsc_ = 0;
  std::int64_t start_real_ns_ = 0, start_cpu_ns_ = 0;
};

}  // namespace tcs
