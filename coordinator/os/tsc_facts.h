// Whether the processor's time stamp counter is a clock: by it time is measured that programs
// compute.
#pragma once

#include <string>
#include <string_view>

namespace tcs {

// By /proc/cpuinfo, or its beginning, in which the first processor is whole.
bool IsTscInvariant(std::string_view cpuinfo);

// Of this host. Where it cannot be read the TSC is taken for invariant.
bool IsHostsTscInvariant();

}  // namespace tcs
