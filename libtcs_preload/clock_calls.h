// The calls that read clocks, under names that no program can put its own in front of: a call that
// is led here from the vDSO must not come back to a function that calls the vDSO.
//
// The functions return what the kernel does, a result or -errno, and leave errno alone.
#pragma once

#include <sys/time.h>
#include <time.h>

#include <cstddef>

namespace tcs::preload {

long ClockGettime(clockid_t id, timespec* ts);
long ClockGetres(clockid_t id, timespec* resolution);
long Gettimeofday(timeval* tv, void* zone);
time_t Time(time_t* out);
long GetCpu(unsigned* cpu, unsigned* node);
long GetRandom(void* buffer, std::size_t size, unsigned flags);

}  // namespace tcs::preload
