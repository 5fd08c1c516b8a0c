// Charges a thread nothing at all: a thread of an ideal robot, whose clock stands still while it
// computes and goes on only while it waits. So the thread never comes to a horizon by what it does.
// A thread that computes on and on is found silent in the end, and waits for others then.
#pragma once

#include "coordinator/host/fixed_meter.h"

namespace tcs {

class IdealMeter final : public FixedMeter {
 public:
  static constexpr HostDuration kLookAgainEvery = HostDuration::Milliseconds(1);  // once silent

  // A thread is found silent after so long, of real time.
  explicit IdealMeter(HostDuration silent_after)
      : FixedMeter(silent_after), most_looks_(silent_after.ns() / kLookEvery.ns()) {}

  void SetRates(const MeteredThread& thread, const SetCosts&, ClockGrant& grant) const override {
    FixedMeter::SetRates(thread, {.call = {}, .allocation = VirtualDuration()}, grant);
  }
  std::uint64_t Begin(MeteredThread& thread, std::uint64_t tsc, bool from_gate,
                      bool is_silent) override {
    thread.silent_looks = 0;
    thread.is_silent = is_silent;
    return FixedMeter::Begin(thread, tsc, from_gate, is_silent);
  }
  HostDuration TimeToLook(MeteredThread& thread, std::uint64_t, ProgramTime) override {
    return thread.is_silent ? kLookAgainEvery : kLookEvery;
  }
  Found Look(MeteredThread& thread, std::uint64_t, ProgramTime, const CpuClock&) override {
    if (!thread.is_silent && ++thread.silent_looks < most_looks_) return Found::kGoesOn;
    thread.is_silent = true;
    return Found::kIsSilent;
  }
  void ChargeCall(MeteredThread&, VirtualDuration) override {}

 private:
  std::int64_t most_looks_;
};

}  // namespace tcs
