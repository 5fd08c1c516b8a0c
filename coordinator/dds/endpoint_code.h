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

// What tells endpoints of one participant apart, and whom they reach; names are DDS's.
struct Endpoint {
  EndpointKind kind = EndpointKind::kWriter;
  std::string topic, type;
  bool keyless = true;
  Qos qos;
  std::string user_data = {};  // what ROS 2 says of the type there (type_hash.h)
};

[[nodiscard]] std::vector<std::byte> EncodeParticipant(std::string_view name,
                                                       std::string_view user_data);
[[nodiscard]] std::vector<std::byte> EncodeEndpoint(const Endpoint& endpoint);

// None for bytes that are no endpoint: they come from clients. Of what is none of our business,
// too, every text lies inside the payload.
[[nodiscard]] std::optional<Endpoint> DecodeEndpoint(std::span<const std::byte> payload);
// The same of a participant.
[[nodiscard]] bool IsParticipant(std::span<const std::byte> payload);
bool IsTopic(std::span<const std::byte> payload);

}  // namespace tcs::dds
