// GUIDs of DDS, as messages carry them (dds_exchange.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace tcs::dds {

// In the order of bytes in which DDS sends them: a participant's twelve, then an endpoint's four.
using Guid = std::array<std::uint8_t, 16>;

// `bytes` points to 16 bytes.
inline Guid GuidAt(const std::uint8_t* bytes) {
  Guid guid;
  std::copy_n(bytes, guid.size(), guid.begin());
  return guid;
}

inline void PutGuid(const Guid& guid, std::uint8_t* bytes) {
  std::copy(guid.begin(), guid.end(), bytes);
}

}  // namespace tcs::dds
