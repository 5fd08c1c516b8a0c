// What calls of the kernel take on this machine, where no filter of tcs looks at them.
#pragma once

#include <cstdint>

namespace tcs {

// In ticks of the TSC, the least of many: a call that does nothing; and what pwritev2 and preadv2
// with RWF_NOWAIT take more than write and read, for a byte in a pipe.
struct CallTimes {
  std::uint64_t plain = 0, write_form = 0, read_form = 0;
};

// All 0 where there is no pipe to be had. Takes a millisecond.
CallTimes MeasureCalls();

}  // namespace tcs
