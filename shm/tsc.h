// The time-stamp counter, as the shim reads it: in an instruction. Where the shim's sources are
// built for the simulated host, the counter is that host's.
#pragma once

#include <x86gprintrin.h>

#include <cstdint>

namespace tcs::shm {

#ifdef TCS_SIMULATED_HOST
std::uint64_t ReadTsc();
#else
inline std::uint64_t ReadTsc() { return __rdtsc(); }
#endif

}  // namespace tcs::shm
