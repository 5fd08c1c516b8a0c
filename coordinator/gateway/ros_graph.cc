#include "coordinator/gateway/ros_graph.h"

#include <algorithm>

#include "coordinator/dds/ros_names.h"
#include "coordinator/dds/ros_types.h"

namespace tcs::gateway {
namespace {

template <class Gid>
void Put(const dds_guid_t& guid, Gid* gid) {
  std::copy(std::begin(guid.v), std::end(guid.v), gid->data);
}

template <class Sequence>
void Put(const std::vector<dds_guid_t>& guids, Sequence* sequence) {
  dds::Resize(sequence, guids.size());
  for (std::size_t i = 0; i < guids.size(); ++i) Put(guids[i], &sequence->_buffer[i]);
}

template <class Message>
void Announce(const Half::Participant& participant, const std::string& user_data) {
  const dds_topic_descriptor_t& type = dds::DescriptorOf<Message>();
  // Both forms of the message have one name.
  dds_topic_descriptor_t named = type;
  named.m_typename = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
  const dds_entity_t topic =
      OrEnd(dds_create_topic(participant.entity, &named, std::string(dds::kDiscoveryTopic).c_str(),
                             nullptr, nullptr),
            "make the topic ros_discovery_info");
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_userdata(qos, user_data.data(), user_data.size());
  const dds_entity_t writer =
      OrEnd(dds_create_writer(participant.entity, topic, qos, nullptr), "announce nodes");
  dds_delete_qos(qos);

  Message message{};
  dds_guid_t guid;
  OrEnd(dds_get_guid(participant.entity, &guid), "find a participant's GUID");
  Put(guid, &message.gid);
  dds::Resize(&message.node_entities_info_seq, participant.nodes.size());
  for (std::size_t i = 0; i < participant.nodes.size(); ++i) {
    auto& node = message.node_entities_info_seq._buffer[i];
    node.node_namespace = dds_string_dup(participant.nodes[i].name_space.c_str());
    node.node_name = dds_string_dup("tcsim");
    Put(participant.nodes[i].readers, &node.reader_gid_seq);
    Put(participant.nodes[i].writers, &node.writer_gid_seq);
  }
  OrEnd(dds_write(writer, &message), "announce nodes");
  dds_sample_free(&message, &type, DDS_FREE_CONTENTS);
}

}  // namespace

void AnnounceNodes(const Half& half, bool is_humble, const std::string& user_data) {
  for (const auto& [domain, participant] : half.participants()) {
    if (is_humble) {
      Announce<dds::HumbleParticipantMessage>(participant, user_data);
    } else {
      Announce<dds::IronParticipantMessage>(participant, user_data);
    }
  }
}

}  // namespace tcs::gateway
