// Spans of time as people say them.
#pragma once

#include <cstdint>
#include <string>

namespace tcs {

// "10 ms", "2.05 s", "153.5 us": three digits, or as many as are whole.
std::string Spoken(std::int64_t ns);

}  // namespace tcs
