// Charges a thread nothing at all: that of an ideal robot, whose clock stands still while it
// computes and goes on only while it waits. So it never comes to a horizon by what it does. One
// that computes on and on is found silent in the end, as under set costs.
#pragma once

#include "coordinator/host/fixed_meter.h"

namespace tcs {

class IdealMeter final : public FixedMeter {
 public:
  static constexpr int kMostLooks = 200;  // kLookEvery apart: 10 s

  void SetRates(const MeteredThread& thread, const SetCosts&, ClockGrant& grant) const override {
    FixedMeter::SetRates(thread, {}, grant);
  }
  Found Look(MeteredThread& thread, std::uint64_t, ProgramTime, const CpuClock&) override {
    if (!thread.is_silent && ++thread.silent_looks < kMostLooks) return Found::kGoesOn;
    thread.is_silent = true;
    return Found::kIsSilent;
  }
  void ChargeCall(MeteredThread&, VirtualDuration) override {}
};

}  // namespace tcs
