// What of switches is not the thread's: from the coordinator's last word to the thread's first, and
// back. That is time that the TSC counts, so the thread's clock begins that much later; and what
// the thread does on its way to its gate is on its CPU clock alone, and excused. Learnt from what
// the thread's CPU clock has not counted of such runs. Pure; the host's nanoseconds.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tcs {

// The runs of a thread since its CPU clock was last asked.
struct UncheckedRuns {
  int count = 0;
  int from_gate = 0;  // of them

  void Add(bool is_from_gate) {
    ++count;
    from_gate += is_from_gate ? 1 : 0;
  }
};

class SwitchCosts {
 public:
  static constexpr double kMostNs = 20'000.0;

  // By how much the clock begins later, for a thread that was preempted; or for one at its gate,
  // which has more of the kernel to run through.
  double Ns(bool from_gate) const {
    return std::max(0.0, from_gate ? from_gate_ns_ : preempted_ns_);
  }
  // What a thread at its gate has had of its processor on the way there, beyond what of its
  // switches is on no CPU clock.
  double ExcusedNs(bool from_gate) const { return from_gate ? std::max(0.0, -from_gate_ns_) : 0; }

  // `stolen_ns`: the time that the thread's own clock has counted in these runs, and that its CPU
  // clock has not. Runs of both kinds tell of neither.
  void Learn(const UncheckedRuns& runs, double stolen_ns) {
    if (runs.count <= 0) return;
    // The time stolen at each run is the switch itself.
    const double more_ns = std::clamp(stolen_ns / runs.count, -kMostNs, kMostNs) / kRuns;
    if (runs.from_gate == runs.count) {
      from_gate_ns_ = std::clamp(from_gate_ns_ + more_ns, -kMostNs, kMostNs);
    } else if (runs.from_gate == 0) {
      preempted_ns_ = std::clamp(preempted_ns_ + more_ns, 0.0, kMostNs);
    }
  }

 private:
  static constexpr int kRuns = 16;  // over which the average is taken

  double preempted_ns_ = 0, from_gate_ns_ = 0;
};

}  // namespace tcs
