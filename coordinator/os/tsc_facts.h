// Whether the processor's time stamp counter is a clock: by it time is measured that programs
// compute.
#pragma once

#include <string>
#include <string_view>

namespace tcs {

enum class TscKind {
  kClock,    // it keeps its rate, and never stops
  kOfGuest,  // it keeps its rate; that it never stops a hypervisor need not say
  kNoClock,
};

// By /proc/cpuinfo, or its beginning, in which the first processor is whole.
TscKind KindOfTsc(std::string_view cpuinfo);

// Of this host. Where it cannot be read the TSC is taken for a clock.
TscKind KindOfHostsTsc();

}  // namespace tcs
