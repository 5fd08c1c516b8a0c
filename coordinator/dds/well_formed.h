// What a message of shm/dds_exchange.h must be before anybody acts on it: programs write them, and
// whatever has come over a program may stand there. What passes here the readers of messages need
// not doubt: sizes hold, names and QoS lie inside, and a sample has at least CDR's own header.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "shm/dds_exchange.h"

namespace tcs::dds {

// What one participant or endpoint may say of itself, names and QoS together. Cyclone's own
// discovery carries at most 64 KiB of each policy.
inline constexpr std::size_t kMostAnnounced = std::size_t{1} << 20;

// `header` is a private copy of what `left` begins with, and `left` all that was sent from there
// on. The complaint is the rest of a sentence about the program that sent it.
[[nodiscard]] std::optional<std::string> WhatIsWrongWithSize(const shm::DdsMessage& header,
                                                             std::size_t left);

// Of one whose size is right.
[[nodiscard]] std::optional<std::string> WhatIsWrong(const shm::DdsMessage& header,
                                                     std::span<const std::byte> payload);

}  // namespace tcs::dds
