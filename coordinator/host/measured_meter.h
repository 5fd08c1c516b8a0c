// Charges a thread the time for which it has run: the time that the TSC counts, less what was
// stolen.
//
// The TSC also counts what others took. So whenever much of it has passed unchecked the thread's
// own CPU clock is asked, and the difference taken out. The coordinator's timer tells of time that
// is on both clocks and yet was not the thread's (stolen_time.h). The thread takes out by itself
// what it finds stolen; where that is more than it can have run, its CPU clock is asked, too.
#pragma once

#include "coordinator/host/meter.h"
#include "coordinator/host/preemption_timer.h"
#include "coordinator/host/switch_costs.h"

namespace tcs {

class MeasuredMeter : public Meter {
 public:
  explicit MeasuredMeter(const TscRate& rate) : rate_(rate) {}

  void SetRates(const MeteredThread& thread, const SetCosts& costs,
                ClockGrant& grant) const override;
  std::uint64_t Begin(MeteredThread& thread, std::uint64_t tsc, bool from_gate,
                      bool is_silent) override;
  HostDuration TimeToLook(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon) override;
  Found Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
             const CpuClock& clock) override;
  bool HasOverslept(std::uint64_t since_tsc, std::uint64_t tsc, HostDuration asked) const override;
  HostDuration TakeOutUnaccounted(MeteredThread& thread, const shm::ClockReading& before,
                                  std::uint64_t tsc, HostDuration asked,
                                  const CpuClock& clock) override;
  void Check(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) override;
  void End(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) override;
  void ChargeCall(MeteredThread&, VirtualDuration) override {}  // the call's time is on the clock

 protected:
  double NsBetween(std::uint64_t tsc, std::uint64_t later_tsc) const {
    return static_cast<double>(later_tsc - tsc) / rate_.ticks_per_ns;
  }

 private:
  bool IsSingleToLookAt(const MeteredThread& thread);
  bool IsAuditDue(const MeteredThread& thread) const;
  void CheckIfDue(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock);

  const TscRate rate_;
  PreemptionTimer timer_;
  SwitchCosts switch_costs_;
  std::uint32_t runs_since_singles_ = 0;
  bool last_single_from_gate_ = false;
};

}  // namespace tcs
