// Charges a thread set costs for its calls and allocations, which its shim adds to its clock, and
// nothing for what it computes between them. So no clock of the host matters, and a thread never
// comes to its horizon by computing: one that spins on what others write to memory would spin for
// ever. It is looked at now and then, and found silent when it has made no call for long.
#pragma once

#include "coordinator/host/meter.h"

namespace tcs {

class FixedMeter : public Meter {
 public:
  static constexpr HostDuration kLookEvery = HostDuration::Milliseconds(50);
  static constexpr int kSilentLooks = 100;  // until it is taken to spin
  static constexpr HostDuration kLookAtSilentEvery = HostDuration::Milliseconds(1);  // from then on

  void SetRates(const MeteredThread& thread, const SetCosts& costs,
                ClockGrant& grant) const override;
  std::uint64_t Begin(MeteredThread& thread, std::uint64_t tsc, bool from_gate,
                      bool is_silent) override;
  HostDuration TimeToLook(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon) override;
  Found Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
             const CpuClock& clock) override;
  bool HasOverslept(std::uint64_t, std::uint64_t, HostDuration) const override { return false; }
  HostDuration TakeOutUntold(MeteredThread&, const shm::ClockReading&, std::uint64_t, HostDuration,
                             const CpuClock&) override {
    return {};
  }
  void Check(MeteredThread&, std::uint64_t, const CpuClock&) override {}
  void End(MeteredThread&, std::uint64_t, const CpuClock&) override {}
  void ChargeCall(MeteredThread& thread, VirtualDuration cost) override;
};

}  // namespace tcs
