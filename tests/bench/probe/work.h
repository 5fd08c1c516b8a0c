// A fixed piece of processor work that never looks at a clock.
#pragma once

#include <cstdint>

namespace tcs::bench {

// Seconds by CLOCK_MONOTONIC that `steps` steps of integer arithmetic took, as the program sees it.
double SecondsOfWork(std::int64_t steps);

}  // namespace tcs::bench
