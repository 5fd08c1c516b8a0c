// Measuring again what could not be measured: a host that stands still for a second breaks programs
// that know real time (ddsperf, libfaketime), which is no reason to lose the minutes before.
#pragma once

#include <optional>

namespace tcs::bench {

inline constexpr int kAttempts = 3;

// What `measure` gives, an optional, the first time that it gives something; it says itself what
// was wrong.
template <typename Measure>
auto Attempt(const Measure& measure) -> decltype(measure()) {
  for (int attempt = 1; attempt < kAttempts; ++attempt) {
    if (auto value = measure()) return value;
  }
  return measure();
}

}  // namespace tcs::bench
