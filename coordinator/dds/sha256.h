// SHA-256 (FIPS 180-4), for the hashes by which ROS 2 knows its types.
#pragma once

#include <string>
#include <string_view>

namespace tcs::dds {

// In 64 hexadecimal digits.
[[nodiscard]] std::string Sha256(std::string_view text);

}  // namespace tcs::dds
