// Charges a thread what its own CPU clock counts, on a processor that it shares with others as
// ordinary tasks (gate_executor.h). The TSC counts the others' time, too; so it only carries the
// clock from one look at the CPU clock to the next. A dispatch begins with such a look, its end is
// one, and no context switch has to be learnt: whatever is not on the CPU clock is not charged.
//
// No clock tells any more of a thread that has died, and whose process the kernel has yet to end:
// the thread has computed what its CPU clock said last.
//
// A thread may have computed beyond its horizon, or after it was held, for as long as nothing
// stopped it: the timer tells nothing of what was stolen.
//
// The coordinator's looks take time from the thread, on the same processor. Where others have most
// of the processor's time, it takes the thread long to come to its horizon, and looks are further
// and further apart.
#pragma once

#include "coordinator/host/measured_meter.h"

namespace tcs {

class SharedCpuMeter final : public MeasuredMeter {
 public:
  using MeasuredMeter::MeasuredMeter;

  std::uint64_t Begin(MeteredThread& thread, std::uint64_t tsc, bool from_gate,
                      bool is_silent) override;
  HostDuration TimeToLook(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon) override;
  Found Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
             const CpuClock& clock) override;
  bool HasOverslept(std::uint64_t, std::uint64_t, HostDuration) const override { return false; }
  void Check(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) override;
  void End(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) override;
};

}  // namespace tcs
