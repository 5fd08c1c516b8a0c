// The checks on a message of shm/dds_exchange.h before anybody acts on it: programs write the
// messages, and a faulty program may have written anything. The readers of messages need not doubt
// a message that passes here: sizes hold, names and QoS lie inside, and a sample has at least CDR's
// own header.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "shm/dds_exchange.h"

namespace tcs::dds {

// The most that one participant or endpoint may say of itself, names and QoS together. Cyclone's
// own discovery carries at most 64 KiB of each policy.
inline constexpr std::size_t kMostAnnounced = std::size_t{1} << 20;

// `header` is a private copy of the beginning of `left`, and `left` all bytes that were sent from
// there on. The complaint is the rest of a sentence about the program that sent the message.
[[nodiscard]] std::optional<std::string> WhatIsWrongWithSize(const shm::DdsMessage& header,
                                                             std::size_t left);

// The size of the message is right.
[[nodiscard]] std::optional<std::string> WhatIsWrong(const shm::DdsMessage& header,
                                                     std::span<const std::byte> payload);

}  // namespace tcs::dds
