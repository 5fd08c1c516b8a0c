// The information of a participant for ROS 2's graph tools, on the topic `ros_discovery_info` (of
// the type rmw_dds_common/msg/ParticipantEntitiesInfo, reliable and transient-local): which nodes
// the participant has, and which endpoints belong to which node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/dds/cdr.h"
#include "coordinator/dds/message.h"

namespace tcs::dds {

struct Node {
  std::string name_space = "/";
  std::string name;
  std::vector<Guid> readers, writers;

  friend bool operator==(const Node&, const Node&) = default;
};

struct ParticipantInfo {
  Guid participant{};
  std::vector<Node> nodes;

  friend bool operator==(const ParticipantInfo&, const ParticipantInfo&) = default;
};

// The type has one name and two forms. A participant that gets the other form cannot read it. So a
// participant that speaks to several others must know which forms they use: the forms of the
// samples that they send themselves.
enum class GidForm {
  kHumble,  // 24 octets, of which the last 8 are zero
  kIron,    // 16 octets: Iron, Jazzy and later
};

[[nodiscard]] std::vector<std::byte> EncodeParticipant(const ParticipantInfo& info, GidForm form);

struct DecodedParticipant {
  ParticipantInfo info;
  GidForm form = GidForm::kHumble;
};

// Decodes a sample of either form.
[[nodiscard]] std::variant<DecodedParticipant, CdrError> DecodeParticipant(
    std::span<const std::byte> cdr);

}  // namespace tcs::dds
