// Proof that a measurement was made where it claims to have been made.
#pragma once

#include <string>

namespace tcs::bench {

// The empty string if the program runs in `world` ("native", "faketime" or "tcs"), else what
// contradicts it.
std::string NotIn(const std::string& world);

}  // namespace tcs::bench
