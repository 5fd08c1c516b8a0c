// Short words for virtual time: At(10 * kMs), AtMs(10).
#pragma once

#include <cstdint>

#include "shm/time_kinds.h"

namespace tcs {

inline constexpr VirtualDuration kNs = VirtualNs(1), kUs = VirtualDuration::Microseconds(1),
                                 kMs = VirtualDuration::Milliseconds(1),
                                 kSecond = VirtualDuration::Seconds(1);

constexpr VirtualDuration Ms(std::int64_t ms) { return VirtualDuration::Milliseconds(ms); }

constexpr VirtualTime At(VirtualDuration since_start) { return VirtualTime() + since_start; }
constexpr VirtualTime AtMs(std::int64_t ms) { return At(Ms(ms)); }

}  // namespace tcs
