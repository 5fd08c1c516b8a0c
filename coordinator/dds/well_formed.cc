#include "coordinator/dds/well_formed.h"

#include <fmt/format.h>

#include "coordinator/dds/endpoint_code.h"

namespace tcs::dds {

namespace {

using shm::DdsKind;
using shm::DdsMessage;

constexpr const char* kMend =
    "it and what it sent with it are lost; is its libtcs_dds.so of "
    "another version?";
// The encapsulation, which says how the rest is encoded.
constexpr std::uint32_t kLeastSample = 4;

std::string Complaint(const std::string& what) {
  return fmt::format("sends a DDS message {}: {}", what, kMend);
}

}  // namespace

std::optional<std::string> WhatIsWrongWithSize(const DdsMessage& header, std::size_t left) {
  if (header.size > left || header.payload_size > shm::kDdsMostPayload ||
      header.size != shm::DdsMessageSize(header.payload_size)) {
    return Complaint(fmt::format("of a wrong size, {}", header.size));
  }
  return std::nullopt;
}

std::optional<std::string> WhatIsWrong(const DdsMessage& header,
                                       std::span<const std::byte> payload) {
  const bool is_announced = (header.flags & shm::kDdsGone) == 0;
  switch (header.kind) {
    case DdsKind::kParticipant:
    case DdsKind::kEndpoint:
    case DdsKind::kTopic:
      if (payload.size() > kMostAnnounced) {
        return fmt::format(
            "has a DDS entity whose names and QoS take {} bytes, more than 1 MiB: other programs "
            "are not told of it; look for user data that is too large",
            payload.size());
      }
      if (is_announced && header.kind == DdsKind::kParticipant && !IsParticipant(payload)) {
        return Complaint("about a participant that cannot be read");
      }
      if (is_announced && header.kind == DdsKind::kEndpoint && !DecodeEndpoint(payload)) {
        return Complaint("about an endpoint that cannot be read");
      }
      if (is_announced && header.kind == DdsKind::kTopic && !IsTopic(payload)) {
        return Complaint("about a topic that cannot be read");
      }
      return std::nullopt;
    case DdsKind::kSample:
      if (payload.size() < kLeastSample) {
        return Complaint(
            fmt::format("with a sample of {} bytes, too few for any CDR", payload.size()));
      }
      return std::nullopt;
    case DdsKind::kHistoryEnd:
    case DdsKind::kLiveliness:
      return std::nullopt;
  }
  return Complaint(fmt::format("of an unknown kind, {}", static_cast<int>(header.kind)));
}

}  // namespace tcs::dds
