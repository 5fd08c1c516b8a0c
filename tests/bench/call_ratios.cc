#include "tests/bench/call_ratios.h"

namespace tcs::bench {

const std::vector<CallBenchmark>& CallBenchmarks() {
  static const Probe native_clock{"clock", World::kNative};
  static const std::vector<CallBenchmark> all{
      {"clock",
       "clock read",
       "clock read natively (vDSO)",
       {"clock", World::kTcs},
       native_clock,
       "ratio <= 1.2"},
      {"exchange",
       "notification round trip",
       "pipe ping-pong, two processes",
       {"exchange", World::kTcs},
       {"ping_pong", World::kNative},
       "ratio <= 1.5"},
      {"sleep",
       "sleep inside the horizon",
       "clock read natively (vDSO)",
       {"sleep", World::kTcs},
       native_clock,
       "<= 100 ns"},
      {"mutex",
       "uncontended mutex",
       "the same natively",
       {"mutex", World::kTcs},
       {"mutex", World::kNative},
       "ratio <= 1.1"},
      {"kernel_call",
       "untrapped system call",
       "the same natively",
       {"kernel_call", World::kTcs},
       {"kernel_call", World::kNative},
       "ratio <= 1.3"},
      {"handover",
       "condition variable",
       "the same natively, SCHED_FIFO",
       {"handover", World::kTcs},
       {"handover", World::kNative},
       "ratio <= 3"},
  };
  return all;
}

std::optional<CallRow> MeasureCall(const CallBenchmark& benchmark, int rounds, double ns_per_tick) {
  std::vector<double> ns, reference_ns, ratios;
  for (int round = 0; round < rounds; ++round) {
    const std::optional<double> reference = RunProbe(benchmark.reference);
    const std::optional<double> ticks = RunProbe(benchmark.probe);
    if (!reference || !ticks) return std::nullopt;
    ns.push_back(*ticks * ns_per_tick);
    reference_ns.push_back(*reference * ns_per_tick);
    ratios.push_back(*ticks / *reference);
  }
  return CallRow{benchmark, SpreadOf(ns).median, SpreadOf(reference_ns).median, SpreadOf(ratios)};
}

}  // namespace tcs::bench
