// A host's TSC and a dispatch, as the tests of meters have them.
#pragma once

#include <cstdint>

#include "coordinator/host/meter.h"
#include "tests/unit/host/nanoseconds.h"

namespace tcs {

inline constexpr std::uint64_t kTicksPerMs = 2'000'000, kTicksPerUs = 2'000;
inline constexpr TscRate kRate{.ns_per_tick_q32 = std::uint64_t{1} << 31, .ticks_per_ns = 2.0};
inline constexpr std::uint64_t kBegun = 1'000 * kTicksPerMs;  // the thread's dispatch, by the TSC
inline constexpr std::int64_t kStart = 50 * kMs;              // its clock then

}  // namespace tcs
