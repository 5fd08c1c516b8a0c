// The time that a context switch takes: from the coordinator's last word to the thread's first, and
// back. That time is not the thread's, so its clock begins that much later. Learnt from what the
// thread's CPU clock has not counted of such runs. Pure; the host's nanoseconds.
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

  // For a thread that was preempted; or for one at its gate, which has more of the kernel to run
  // through.
  double Ns(bool from_gate) const { return from_gate ? from_gate_ns_ : preempted_ns_; }

  // `stolen_ns`: the time that the thread's own clock has counted in these runs, and that its CPU
  // clock has not. Runs of both kinds tell of neither.
  void Learn(const UncheckedRuns& runs, double stolen_ns) {
    if (runs.count <= 0) return;
    const bool all_from_gate = runs.from_gate == runs.count;
    if (!all_from_gate && runs.from_gate != 0) return;
    // The time stolen at each run is the switch itself.
    const double more_ns = std::clamp(stolen_ns / runs.count, -kMostNs, kMostNs);
    double& known_ns = all_from_gate ? from_gate_ns_ : preempted_ns_;
    known_ns = std::clamp(known_ns + more_ns / kRuns, 0.0, kMostNs);
  }

 private:
  static constexpr int kRuns = 16;  // over which the average is taken

  double preempted_ns_ = 0, from_gate_ns_ = 0;
};

}  // namespace tcs
