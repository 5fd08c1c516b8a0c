// Whether the processor's time stamp counter is a clock: by the counter the time is measured that
// programs compute.
#pragma once

#include <string>
#include <string_view>

namespace tcs {

enum class TscKind {
  kClock,    // the counter keeps its rate, and never stops
  kOfGuest,  // the counter keeps its rate; a hypervisor need not say that it never stops
  kNoClock,
};

// The kind by /proc/cpuinfo, or its beginning, in which the first processor is whole.
TscKind KindOfTsc(std::string_view cpuinfo);

// The kind of this host's TSC. Where /proc/cpuinfo cannot be read the TSC is taken for a clock.
TscKind KindOfHostsTsc();

}  // namespace tcs
