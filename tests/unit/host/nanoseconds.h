// Times of one program, or of the host, as counts of nanoseconds.
#pragma once

#include <cstdint>

namespace tcs {

inline constexpr std::int64_t kMs = 1'000'000, kUs = 1'000;

}  // namespace tcs
