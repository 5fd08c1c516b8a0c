#include "coordinator/gateway/half.h"

#include <stdio.h>
#include <stdlib.h>

#include <algorithm>
#include <cstring>

#include "coordinator/gateway/raw_type.h"

namespace tcs::gateway {
namespace {

constexpr int kTakenAtOnce = 16;
// ROS 2's middleware takes participants with this user data for its own kind, with nodes.
constexpr const char* kEnclave = "enclave=/;";

void SetQos(dds_qos_t* to, const ServedEnd& end, Side side) {
  const dds::Qos& qos = end.qos;
  const bool is_reliable = qos.reliability == dds::Reliability::kReliable;
  const bool keeps_all = qos.history == dds::History::kKeepAll;
  const auto ns = [](const std::optional<VirtualDuration>& duration) {
    return duration ? duration->ns() : DDS_INFINITY;
  };
  const bool in_simulation = side == Side::kSimulation;
  // On the way between the simulation and the stream nothing is lost, and each end matches.
  const bool is_whole = in_simulation && !end.is_sensor;
  dds_qset_reliability(
      to, is_reliable || is_whole ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
      DDS_INFINITY);
  dds_qset_history(to, keeps_all || in_simulation ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST,
                   qos.depth);
  dds_qset_durability(to, qos.durability == dds::Durability::kTransientLocal
                              ? DDS_DURABILITY_TRANSIENT_LOCAL
                              : DDS_DURABILITY_VOLATILE);
  dds_qset_durability_service(to, 0, keeps_all ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST,
                              qos.depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED);
  dds_qset_deadline(to, ns(qos.deadline));
  if (end.is_sensor && !in_simulation) dds_qset_lifespan(to, ns(qos.lifespan));
  dds_qset_liveliness(to, static_cast<dds_liveliness_kind_t>(qos.liveliness), ns(qos.lease));
  dds_qset_ignorelocal(to, DDS_IGNORELOCAL_PARTICIPANT);
  dds_qset_userdata(to, end.user_data.data(), end.user_data.size());
}

}  // namespace

dds_return_t OrEnd(dds_return_t result, const char* what) {
  if (result >= 0) return result;
  fprintf(stderr, "tcs-dds-gateway: cannot %s: %s\n", what, dds_strretcode(result));
  _Exit(1);
}

Half::Half(Side side, const std::vector<ServedEnd>& ends, Frames& frames)
    : side_(side), frames_(frames), heard_(ends.size()) {
  own_.reserve(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    heard_[i] = {this, static_cast<std::uint32_t>(i)};
    Add(ends[i], &heard_[i]);
  }
}

bool Half::Reads(const ServedEnd& end) const {
  return end.is_sensor == (side_ == Side::kSimulation);
}

Half::Participant& Half::ParticipantOf(int domain) {
  Participant& participant = participants_[domain];
  if (participant.entity != 0) return participant;
  dds_qos_t* qos = dds_create_qos();
  if (side_ == Side::kPrograms) dds_qset_userdata(qos, kEnclave, strlen(kEnclave));
  participant.entity =
      OrEnd(dds_create_participant(static_cast<dds_domainid_t>(domain), qos, nullptr),
            "make a participant");
  dds_delete_qos(qos);
  return participant;
}

void Half::Add(const ServedEnd& end, Heard* heard) {
  Participant& participant = ParticipantOf(end.domain);
  ddsi_sertype* type = NewRawType(end.type);  // or the one that Cyclone has already
  const dds_entity_t topic = OrEnd(dds_create_topic_sertype(participant.entity, end.topic.c_str(),
                                                            &type, nullptr, nullptr, nullptr),
                                   ("make the topic " + end.topic).c_str());
  Own own;
  own.type = type;
  dds_qos_t* qos = dds_create_qos();
  SetQos(qos, end, side_);
  if (Reads(end)) {
    dds_listener_t* listener = dds_create_listener(heard);
    dds_lset_data_available(listener, TakeAll);
    own.endpoint = OrEnd(dds_create_reader(participant.entity, topic, qos, listener),
                         ("read " + end.topic).c_str());
    dds_delete_listener(listener);
  } else {
    own.endpoint = OrEnd(dds_create_writer(participant.entity, topic, qos, nullptr),
                         ("write " + end.topic).c_str());
  }
  dds_delete_qos(qos);
  own_.push_back(own);

  std::vector<Node>& nodes = participant.nodes;
  auto node = std::find_if(nodes.begin(), nodes.end(), [&end](const Node& known) {
    return known.name_space == end.name_space;
  });
  if (node == nodes.end()) node = nodes.insert(node, Node{end.name_space, {}, {}});
  dds_guid_t guid;
  OrEnd(dds_get_guid(own.endpoint, &guid), "find an endpoint's GUID");
  (Reads(end) ? node->readers : node->writers).push_back(guid);
}

// Runs in the thread that hands samples over: no other thread has to wake up for them.
void Half::TakeAll(dds_entity_t reader, void* of) {
  const Heard& heard = *static_cast<const Heard*>(of);
  ddsi_serdata* samples[kTakenAtOnce];
  dds_sample_info_t infos[kTakenAtOnce];
  int taken = 0;
  while ((taken = dds_takecdr(reader, samples, kTakenAtOnce, infos, DDS_ANY_STATE)) > 0) {
    for (int i = 0; i < taken; ++i) {
      if (infos[i].valid_data) {
        heard.half->frames_.Send(heard.end, infos[i].source_timestamp, BytesOf(samples[i]));
      }
      ddsi_serdata_unref(samples[i]);
    }
  }
}

void Half::Write(const Frame& frame) {
  const Own& own = own_[frame.end];
  dds_forwardcdr(own.endpoint, NewRawSample(own.type, frame.cdr, frame.timestamp_ns));
}

}  // namespace tcs::gateway
