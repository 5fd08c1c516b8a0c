// A span of real time as people read it.
#pragma once

#include <string>

namespace tcs {

// "1:02:03", "12:34", "5 s"
std::string AsTime(double seconds);

}  // namespace tcs
