// Figures of all runs of a system together, as one number.
#pragma once

#include <algorithm>
#include <cstdint>

#include "coordinator/report/results.h"

namespace tcs::report {

// In seconds.
[[nodiscard]] inline double MeanOf(const System& system, std::int64_t Run::*member) {
  if (system.runs.empty()) return 0;
  double sum = 0;
  for (const Run& run : system.runs) sum += static_cast<double>(run.*member) * 1e-9;
  return sum / static_cast<double>(system.runs.size());
}

[[nodiscard]] inline double MostOf(const System& system, std::int64_t Run::*member) {
  std::int64_t most = 0;
  for (const Run& run : system.runs) most = std::max(most, run.*member);
  return static_cast<double>(most) * 1e-9;
}

// The coordinator's share of the real time of all runs together.
[[nodiscard]] inline double OverheadOf(const System& system) {
  const double real = MeanOf(system, &Run::real_ns);
  return real > 0 ? MeanOf(system, &Run::coordinating_ns) / real : 0;
}

}  // namespace tcs::report
