// Charges a thread set costs for its calls and allocations, which its shim adds to its clock, and
// nothing for what it computes between them. So no clock of the host matters, and a thread never
// comes to its horizon by computing: a thread that spins on what others write to memory would spin
// for ever. The coordinator looks at such a thread now and then, and finds it silent when it has
// made no call for long.
//
// From then on the thread's client is known to compute for long without calls: a thread of that
// client that has computed for half a millisecond by its own CPU clock since its last call is
// charged as much, a set cost. So the thread comes to its horizon as any other thread does. The
// host decides where between its calls that happens.
#pragma once

#include "coordinator/host/meter.h"

namespace tcs {

class FixedMeter : public Meter {
 public:
  static constexpr HostDuration kLookEvery = HostDuration::Milliseconds(50);
  // For a client that is known to compute for long without calls.
  static constexpr HostDuration kLookAtSilentEvery = HostDuration::Microseconds(500);
  static constexpr VirtualDuration kSilentCost = VirtualDuration::Microseconds(500);

  // A thread is found silent after so long by its CPU clock, whoever else has the processor.
  explicit FixedMeter(HostDuration silent_after) : silent_after_(silent_after) {}

  void SetRates(const MeteredThread& thread, const SetCosts& costs,
                ClockGrant& grant) const override;
  std::uint64_t Begin(MeteredThread& thread, std::uint64_t tsc, bool from_gate,
                      bool is_silent) override;
  HostDuration TimeToLook(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon) override;
  Found Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
             const CpuClock& clock) override;
  bool HasOverslept(std::uint64_t, std::uint64_t, HostDuration) const override { return false; }
  HostDuration TakeOutUnaccounted(MeteredThread&, const shm::ClockReading&, std::uint64_t,
                                  HostDuration, const CpuClock&) override {
    return {};
  }
  void Check(MeteredThread&, std::uint64_t, const CpuClock&) override {}
  void End(MeteredThread&, std::uint64_t, const CpuClock&) override {}
  void ChargeCall(MeteredThread& thread, VirtualDuration cost) override;

 private:
  static Found LookAtSilent(MeteredThread& thread, const shm::ClockReading& now,
                            ProgramTime horizon, std::int64_t cpu_ns);

  HostDuration silent_after_;
};

}  // namespace tcs
