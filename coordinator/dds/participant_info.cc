#include "coordinator/dds/participant_info.h"

#include <algorithm>

#include "coordinator/dds/ros_types.h"

namespace tcs::dds {
namespace {

template <class Sequence>
void SetGuids(Sequence* sequence, const std::vector<Guid>& guids) {
  Resize(sequence, guids.size());
  for (std::size_t i = 0; i < guids.size(); ++i) PutGuid(guids[i], sequence->_buffer[i].data);
}

template <class Sequence>
std::vector<Guid> ToGuids(const Sequence& sequence) {
  std::vector<Guid> guids;
  for (std::size_t i = 0; i < sequence._length; ++i)
    guids.push_back(GuidAt(sequence._buffer[i].data));
  return guids;
}

template <class Message>
std::vector<std::byte> Encode(const ParticipantInfo& info) {
  Owned<Message> message;
  PutGuid(info.participant, message->gid.data);
  Resize(&message->node_entities_info_seq, info.nodes.size());
  for (std::size_t i = 0; i < info.nodes.size(); ++i) {
    auto& node = message->node_entities_info_seq._buffer[i];
    SetText(&node.node_namespace, info.nodes[i].name_space);
    SetText(&node.node_name, info.nodes[i].name);
    SetGuids(&node.reader_gid_seq, info.nodes[i].readers);
    SetGuids(&node.writer_gid_seq, info.nodes[i].writers);
  }
  return ToCdr(message);
}

template <class Message>
ParticipantInfo ToInfo(const Message& message) {
  ParticipantInfo info{GuidAt(message.gid.data), {}};
  for (std::size_t i = 0; i < message.node_entities_info_seq._length; ++i) {
    const auto& node = message.node_entities_info_seq._buffer[i];
    info.nodes.push_back({node.node_namespace, node.node_name, ToGuids(node.reader_gid_seq),
                          ToGuids(node.writer_gid_seq)});
  }
  return info;
}

}  // namespace

std::vector<std::byte> EncodeParticipant(const ParticipantInfo& info, GidForm form) {
  return form == GidForm::kHumble ? Encode<HumbleParticipantMessage>(info)
                                  : Encode<IronParticipantMessage>(info);
}

std::variant<DecodedParticipant, CdrError> DecodeParticipant(std::span<const std::byte> cdr) {
  // In the other form lengths would be read from the middle of a GUID or a name, and not come out.
  auto humble = FromCdr<HumbleParticipantMessage>(cdr);
  if (const auto* message = std::get_if<Owned<HumbleParticipantMessage>>(&humble)) {
    return DecodedParticipant{ToInfo(**message), GidForm::kHumble};
  }
  const auto iron = FromCdr<IronParticipantMessage>(cdr);
  if (const auto* message = std::get_if<Owned<IronParticipantMessage>>(&iron)) {
    return DecodedParticipant{ToInfo(**message), GidForm::kIron};
  }
  return std::get<CdrError>(std::move(humble));
}

}  // namespace tcs::dds
