// Participants and endpoints as they stand in the hub's messages (shm/dds_endpoint.h).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/dds/qos.h"
#include "coordinator/dds/topics_file.h"

namespace tcs::dds {

// The properties that tell endpoints of one participant apart, and decide whom they reach; names
// are DDS's.
struct Endpoint {
  EndpointKind kind = EndpointKind::kWriter;
  std::string topic, type;
  bool keyless = true;
  Qos qos;
  std::string user_data = {};  // ROS 2's information on the type (type_hash.h)
};

[[nodiscard]] std::vector<std::byte> EncodeParticipant(std::string_view name,
                                                       std::string_view user_data);
[[nodiscard]] std::vector<std::byte> EncodeEndpoint(const Endpoint& endpoint);

// None: the bytes are no endpoint; they come from clients. Texts that are none of our business lie
// inside the payload, too.
[[nodiscard]] std::optional<Endpoint> DecodeEndpoint(std::span<const std::byte> payload);
// The same, for a participant.
[[nodiscard]] bool IsParticipant(std::span<const std::byte> payload);
bool IsTopic(std::span<const std::byte> payload);

}  // namespace tcs::dds
