// Shows the graph as ROS 2's middleware makes it out: the nodes of `ros_discovery_info`, and what
// they publish and subscribe to by the GUIDs of DDS's built-in topics. A line for each:
//   /hunter/tcsim publishes rt/odom nav_msgs::msg::dds_::Odometry_ RIHS01_3cc97d…
// with the hash of the type, if the endpoint has one that ROS 2 can read.
// Endpoints of no node are named so; so are GUIDs of nodes that no endpoint has. It joins half a
// second after its start.
//   ros_graph humble|iron
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "dds/dds.h"
#include "rmw_dds_common.h"
#include "rmw_dds_common_iron.h"
#include "tests/programs/dds_program.h"

namespace {

using Bytes = std::string;

Bytes ToBytes(const dds_guid_t& guid) { return Bytes(reinterpret_cast<const char*>(guid.v), 16); }

// The rest of the octets must be zero.
template <class Gid>
Bytes ToBytes(const Gid& gid) {
  for (std::size_t i = 16; i < sizeof gid.data; ++i) {
    if (gid.data[i] != 0) OrDie(DDS_RETCODE_BAD_PARAMETER, "take a gid for a GUID");
  }
  return Bytes(reinterpret_cast<const char*>(gid.data), 16);
}

template <class Sample>
void TakeAll(dds_entity_t reader, const std::function<void(const Sample&)>& each) {
  void* sample = nullptr;
  dds_sample_info_t info;
  while (OrDie(dds_take(reader, &sample, &info, 1, 1), "take") > 0) {
    if (info.valid_data) each(*static_cast<const Sample*>(sample));
    dds_return_loan(reader, &sample, 1);
  }
}

// The hash of an endpoint's type, as rmw_dds_common finds it in USER_DATA: with a space before it.
std::string TypeHash(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(qos, &data, &size)) return "";
  const std::string text(static_cast<char*>(data), size);
  dds_free(data);
  std::smatch found;
  if (!std::regex_search(text, found, std::regex("(^|;)typehash=(RIHS01_[0-9a-f]{64});")))
    return "";
  return " " + found[2].str();
}

struct Endpoint {
  std::string topic, type;  // the type with its hash
  Bytes participant;
};

struct Graph {
  std::set<Bytes> participants;                // that ROS 2 takes for its own
  std::map<Bytes, Endpoint> readers, writers;  // by their GUIDs
  std::set<std::string> lines;

  // One end of what a node has.
  void Tell(const std::string& node, const char* does, const Bytes& participant, const Bytes& guid,
            std::map<Bytes, Endpoint>* known) {
    const auto found = known->find(guid);
    if (found == known->end()) {
      lines.insert(node + " " + does + " what nobody has");
      return;
    }
    const bool same = found->second.participant == participant;
    lines.insert(node + " " + does + " " + found->second.topic + " " + found->second.type +
                 (same ? "" : " of another participant"));
    known->erase(found);
  }

  template <class Message>
  void Tell(const Message& message) {
    const Bytes participant = ToBytes(message.gid);
    for (std::size_t i = 0; i < message.node_entities_info_seq._length; ++i) {
      const auto& node = message.node_entities_info_seq._buffer[i];
      const std::string slash = strcmp(node.node_namespace, "/") == 0 ? "" : "/";
      const std::string name = node.node_namespace + slash + node.node_name;
      lines.insert(name + (participants.contains(participant) ? "" : " has no enclave"));
      for (std::size_t j = 0; j < node.writer_gid_seq._length; ++j) {
        Tell(name, "publishes", participant, ToBytes(node.writer_gid_seq._buffer[j]), &writers);
      }
      for (std::size_t j = 0; j < node.reader_gid_seq._length; ++j) {
        Tell(name, "subscribes to", participant, ToBytes(node.reader_gid_seq._buffer[j]), &readers);
      }
    }
  }
};

template <class Message>
void Show(const dds_topic_descriptor_t& described) {
  // A type is known by its name, which the two forms share.
  dds_topic_descriptor_t type = described;
  type.m_typename = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
  const dds_entity_t participant = OrDie(dds_create_participant(0, nullptr, nullptr), "join");
  const auto built_in = [participant](dds_entity_t which) {
    return OrDie(dds_create_reader(participant, which, nullptr, nullptr), "read built-in topics");
  };
  const dds_entity_t participants = built_in(DDS_BUILTIN_TOPIC_DCPSPARTICIPANT);
  const dds_entity_t writers = built_in(DDS_BUILTIN_TOPIC_DCPSPUBLICATION);
  const dds_entity_t readers = built_in(DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION);
  // As rmw_cyclonedds asks for it, which knows no other topic yet.
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  const dds_entity_t topic =
      OrDie(dds_create_topic(participant, &type, "ros_discovery_info", nullptr, nullptr), "topic");
  const dds_entity_t info = OrDie(dds_create_reader(participant, topic, qos, nullptr), "read");
  dds_sleepfor(DDS_MSECS(300));

  Graph graph;
  TakeAll<dds_builtintopic_participant_t>(participants, [&graph](const auto& sample) {
    void* data = nullptr;
    std::size_t size = 0;
    if (!dds_qget_userdata(sample.qos, &data, &size)) return;
    if (std::string(static_cast<char*>(data), size).find("enclave=/;") != std::string::npos) {
      graph.participants.insert(ToBytes(sample.key));
    }
    dds_free(data);
  });
  const auto keep = [&graph](std::map<Bytes, Endpoint>* known) {
    return [known, &graph](const dds_builtintopic_endpoint_t& sample) {
      const std::string known_type = sample.type_name + TypeHash(sample.qos);
      if (strncmp(sample.topic_name, "rt/", 3) == 0) {
        (*known)[ToBytes(sample.key)] = {sample.topic_name, known_type,
                                         ToBytes(sample.participant_key)};
      } else if (known == &graph.writers) {
        graph.lines.insert("nodes are told of by " + known_type);
      }
    };
  };
  TakeAll<dds_builtintopic_endpoint_t>(writers, keep(&graph.writers));
  TakeAll<dds_builtintopic_endpoint_t>(readers, keep(&graph.readers));
  TakeAll<Message>(info, [&graph](const Message& message) { graph.Tell(message); });
  for (const auto& [guid, endpoint] : graph.writers) {
    graph.lines.insert("nobody publishes " + endpoint.topic + " " + endpoint.type);
  }
  for (const auto& [guid, endpoint] : graph.readers) {
    graph.lines.insert("nobody subscribes to " + endpoint.topic + " " + endpoint.type);
  }
  for (const std::string& line : graph.lines) printf("%s\n", line.c_str());
  OrDie(dds_delete(participant), "leave");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  dds_sleepfor(DDS_MSECS(500));
  if (strcmp(argv[1], "humble") == 0) {
    Show<rmw_dds_common_msg_dds__ParticipantEntitiesInfo_>(
        rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc);
  } else {
    Show<rmw_dds_common_iron_msg_dds__ParticipantEntitiesInfo_>(
        rmw_dds_common_iron_msg_dds__ParticipantEntitiesInfo__desc);
  }
  return 0;
}
