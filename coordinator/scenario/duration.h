// Durations as people write them, in scenarios and on the command line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "coordinator/errors/load_error.h"
#include "shm/virtual_time.h"

namespace tcs {

// "1ms", "20s", "1.5 s", "0.01" (no unit: seconds), "1e-3"; units ns, us (or µs), ms, s, min, h.
// The decimal number is taken exactly: a duration that is not a whole number of nanoseconds is an
// error, as is one that is negative or above kLongestDuration. Zero is a duration. Independent of
// the locale.
[[nodiscard]] LoadResult<VirtualDuration> ParseDuration(std::string_view text);

// The duration in seconds, as ParseDuration reads it: "12.5s".
[[nodiscard]] std::string SecondsText(std::int64_t ns);

// Leaves room to add two such durations: 146 years.
inline constexpr VirtualDuration kLongestDuration =
    VirtualDuration::Nanoseconds(std::int64_t{1} << 62);

}  // namespace tcs
