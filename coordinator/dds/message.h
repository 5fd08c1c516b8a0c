// Messages of shm/dds_exchange.h as the coordinator keeps them: header, payload and padding, one
// after another.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "shm/dds_exchange.h"
#include "shm/dds_guid.h"

namespace tcs::dds {

// The bytes that all GUIDs of a participant have in common.
using GuidPrefix = std::array<std::uint8_t, 12>;

inline GuidPrefix PrefixOf(const Guid& guid) {
  GuidPrefix prefix;
  std::copy_n(guid.begin(), prefix.size(), prefix.begin());
  return prefix;
}

// `message` holds at least a header, at any alignment.
inline shm::DdsMessage HeaderOf(std::span<const std::byte> message) {
  shm::DdsMessage header;
  std::memcpy(&header, message.data(), sizeof header);
  return header;
}

// Writes this header into a message like that.
inline void PutHeader(const shm::DdsMessage& header, std::span<std::byte> message) {
  std::memcpy(message.data(), &header, sizeof header);
}

// Whether the message is for one endpoint only.
inline bool IsAddressed(const shm::DdsMessage& header) { return GuidAt(header.other) != Guid{}; }

// The payload of a whole message whose header is true.
inline std::span<const std::byte> PayloadOf(std::span<const std::byte> message) {
  return message.subspan(sizeof(shm::DdsMessage), HeaderOf(message).payload_size);
}

}  // namespace tcs::dds
