#include "libtcs_preload/dds/mirrors.h"

#include <utility>
#include <vector>

#include "libtcs_preload/dds/catch_up.h"
#include "libtcs_preload/dds/identity.h"
#include "libtcs_preload/dds/ignore_local.h"
#include "libtcs_preload/dds/liveliness.h"
#include "libtcs_preload/dds/program.h"
#include "libtcs_preload/dds/say.h"
#include "libtcs_preload/dds/tap.h"

namespace tcs::dds {
namespace {

// QoS that a message carries, as long as it lives.
class Qos {
 public:
  explicit Qos(dds_qos_t* qos) : qos_(qos) {}
  ~Qos() { dds_delete_qos(qos_); }
  Qos(const Qos&) = delete;
  Qos& operator=(const Qos&) = delete;
  dds_qos_t* get() const { return qos_; }

 private:
  dds_qos_t* qos_;
};

// Of an endpoint, as its shadow has them: it is to match what is in this process.
dds_qos_t* ShadowQos(const Payload& payload) {
  dds_qos_t* qos = DecodeQos(payload, false);
  dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_NONE);
  return qos;
}

// How often a reader that is full is tried, as by Cyclone's own threads.
constexpr dds_duration_t kTryAgain = DDS_MSECS(1);

// False: the reader is full.
bool StoreIn(ddsi_domaingv* gv, const Guid& guid, const ddsi_guid_t& shadow_guid,
             ddsi_serdata* sample) {
  const Awake awake(gv);
  const ddsi_guid_t inner = guid.Inner();
  const ddsi_reader* reader = entidx_lookup_reader_guid(gv->entity_index, &inner);
  const ddsi_writer* shadow = entidx_lookup_writer_guid(gv->entity_index, &shadow_guid);
  return reader == nullptr || shadow == nullptr || StoreAddressed(*reader, *shadow, sample);
}

bool IsReliable(const dds_qos_t* qos) {
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_duration_t blocking = 0;
  dds_qget_reliability(qos, &reliability, &blocking);
  return reliability == DDS_RELIABILITY_RELIABLE;
}

bool IsTransientLocal(const dds_qos_t* qos) {
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_qget_durability(qos, &durability);
  return durability >= DDS_DURABILITY_TRANSIENT_LOCAL;
}

}  // namespace

void Mirrors::Handle(const shm::DdsMessage& message, const std::byte* payload) {
  if (message.payload_size > message.size - sizeof(message)) return;
  switch (message.kind) {
    case shm::DdsKind::kParticipant:
      HandleParticipant(message, Payload(payload, payload + message.payload_size));
      return;
    case shm::DdsKind::kEndpoint:
      HandleEndpoint(message, Payload(payload, payload + message.payload_size));
      return;
    case shm::DdsKind::kSample:
      HandleSample(message, payload);
      return;
    case shm::DdsKind::kHistoryEnd:
      HandleHistoryEnd(message);
      return;
    case shm::DdsKind::kLiveliness:
      HandleLiveliness(message);
      return;
  }
}

void Mirrors::HandleParticipant(const shm::DdsMessage& message, Payload payload) {
  const Guid guid = Guid::FromBytes(message.subject);
  if ((message.flags & shm::kDdsGone) != 0) {
    RemoveParticipant(guid);
    return;
  }
  Participant& participant = participants_[guid];
  const bool changed = participant.shadow > 0 && participant.payload != payload;
  participant.domain = message.domain;
  participant.process = message.from;
  participant.tag = message.instance;
  participant.payload = std::move(payload);
  if (changed) {
    const Qos qos(DecodeQos(participant.payload, true));
    dds_set_qos(participant.shadow, qos.get());
  }
  MakeParticipant(guid, participant);
}

void Mirrors::HandleEndpoint(const shm::DdsMessage& message, Payload payload) {
  const Guid guid = Guid::FromBytes(message.subject);
  if ((message.flags & shm::kDdsGone) != 0) {
    RemoveEndpoint(guid);
    return;
  }
  Endpoint& endpoint = endpoints_[guid];
  if (endpoint.shadow > 0) {
    if (endpoint.payload != payload) ChangeQos(endpoint, std::move(payload));
    return;
  }
  endpoint.participant = Guid::FromBytes(message.other);
  endpoint.domain = message.domain;
  endpoint.process = message.from;
  endpoint.payload = std::move(payload);
  endpoint.what = DecodeEndpoint(endpoint.payload);
  MakeEndpoint(guid, endpoint);
}

// Some policies are the publisher's, the subscriber's or the topic's.
void Mirrors::ChangeQos(Endpoint& endpoint, Payload payload) {
  endpoint.payload = std::move(payload);
  const Qos qos(ShadowQos(endpoint.payload));
  dds_set_qos(dds_get_topic(endpoint.shadow), qos.get());
  dds_set_qos(dds_get_parent(endpoint.shadow), qos.get());
  dds_set_qos(endpoint.shadow, qos.get());
}

void Mirrors::RemoveParticipant(const Guid& guid) {
  const auto found = participants_.find(guid);
  if (found == participants_.end()) return;
  EndShadow(guid, found->second);
  participants_.erase(found);
  std::erase_if(endpoints_,
                [&guid](const auto& endpoint) { return endpoint.second.participant == guid; });
}

void Mirrors::RemoveEndpoint(const Guid& guid) {
  const auto found = endpoints_.find(guid);
  if (found == endpoints_.end()) return;
  const dds_entity_t shadow = found->second.shadow;
  endpoints_.erase(found);
  if (shadow > 0) Real().dds_delete(shadow);
}

void Mirrors::EndShadow(const Guid& guid, Participant& participant) {
  if (participant.shadow <= 0) return;
  const dds_entity_t shadow = participant.shadow;
  participant.shadow = 0;
  participant.topics.clear();
  for (auto& [key, endpoint] : endpoints_) {
    if (endpoint.participant == guid) {
      endpoint.shadow = 0;
      endpoint.type = nullptr;
    }
  }
  Real().dds_delete(shadow);
  RemoveShadow(guid);
}

void Mirrors::Complete() {
  for (auto& [guid, participant] : participants_) MakeParticipant(guid, participant);
  for (auto& [guid, endpoint] : endpoints_) MakeEndpoint(guid, endpoint);
}

void Mirrors::Close(std::uint32_t domain) {
  if (DomainOf(domain) != nullptr) return;  // the program has made another participant meanwhile
  for (auto& [guid, participant] : participants_) {
    if (participant.domain == domain) EndShadow(guid, participant);
  }
}

void Mirrors::MakeParticipant(const Guid& guid, Participant& participant) {
  const ddsi_domaingv* gv = DomainOf(participant.domain);
  if (participant.shadow > 0 || gv == nullptr) return;
  if (participant.process != shm::kDdsCoordinator &&
      participant.tag != shm::DdsTag(gv->config.domainTag)) {
    return;
  }
  AddShadow(guid);
  const Qos qos(DecodeQos(participant.payload, true));
  const MakingShadow making(guid);
  participant.shadow = Real().dds_create_participant(participant.domain, qos.get(), nullptr);
  if (participant.shadow <= 0) {
    RemoveShadow(guid);
    Say("cannot mirror a DDS participant of another program: %s",
        dds_strretcode(participant.shadow));
  }
}

void Mirrors::MakeEndpoint(const Guid& guid, Endpoint& endpoint) {
  if (endpoint.shadow > 0 || endpoint.what.topic.empty()) return;
  const auto owner = participants_.find(endpoint.participant);
  ddsi_domaingv* gv = DomainOf(endpoint.domain);
  if (owner == participants_.end() || owner->second.shadow <= 0 || gv == nullptr) return;
  Participant& participant = owner->second;
  const Qos qos(ShadowQos(endpoint.payload));
  const dds_entity_t topic = TopicOf(gv, endpoint, participant, qos.get());
  if (topic <= 0) return;
  SetNextEntity(gv, endpoint.participant, guid);
  const ShadowMatches matches(gv);
  if (endpoint.what.kind == shm::kDdsWriter) {
    MakeWriter(endpoint, participant.shadow, topic, qos.get());
  } else {
    MakeReader(guid, endpoint, gv, participant.shadow, topic, qos.get());
  }
  if (endpoint.shadow <= 0 && !endpoint.warned) {
    endpoint.warned = true;
    Say("cannot mirror a %s of DDS topic %s of another program: %s",
        endpoint.what.kind == shm::kDdsWriter ? "writer" : "reader", endpoint.what.topic.c_str(),
        dds_strretcode(endpoint.shadow));
  }
}

// 0: the program does not have it.
dds_entity_t Mirrors::TopicOf(ddsi_domaingv* gv, const Endpoint& endpoint, Participant& participant,
                              const dds_qos_t* qos) {
  const auto found = participant.topics.find({endpoint.what.topic, endpoint.what.type});
  if (found != participant.topics.end()) return found->second;
  ddsi_sertype* type = ReferType(endpoint.domain, endpoint.what.topic, endpoint.what.type);
  if (type == nullptr) return 0;
  const Qos topic_qos(dds_create_qos());
  void* data = nullptr;
  std::size_t size = 0;
  if (dds_qget_topicdata(qos, &data, &size)) {
    dds_qset_topicdata(topic_qos.get(), data, size);
    dds_free(data);
  }
  SetNextEntityOutOfTheWay(gv, endpoint.participant);
  ddsi_sertype* consumed = type;
  const dds_entity_t topic =
      Real().dds_create_topic_sertype(participant.shadow, endpoint.what.topic.c_str(), &consumed,
                                      topic_qos.get(), nullptr, nullptr);
  if (topic <= 0) {
    ddsi_sertype_unref(type);
    Say("cannot mirror DDS topic %s: %s", endpoint.what.topic.c_str(), dds_strretcode(topic));
    return topic;
  }
  participant.topics[{endpoint.what.topic, endpoint.what.type}] = topic;
  return topic;
}

void Mirrors::MakeWriter(Endpoint& endpoint, dds_entity_t participant, dds_entity_t topic,
                         dds_qos_t* qos) {
  endpoint.shadow = dds_create_writer(participant, topic, qos, nullptr);
  dds_guid_t wire;
  if (endpoint.shadow <= 0 || dds_get_guid(endpoint.shadow, &wire) != DDS_RETCODE_OK) return;
  endpoint.inner = Guid::FromBytes(wire.v).Inner();
  ddsi_domaingv* gv = DomainOf(endpoint.domain);
  if (gv == nullptr) return;
  const Awake awake(gv);
  const ddsi_writer* writer = entidx_lookup_writer_guid(gv->entity_index, &endpoint.inner);
  endpoint.type = writer != nullptr ? writer->type : nullptr;
}

void Mirrors::MakeReader(const Guid& guid, Endpoint& endpoint, ddsi_domaingv* gv,
                         dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos) {
  Tap* tap = NewTap(gv, endpoint.domain, endpoint.process, guid, endpoint.what.topic,
                    IsReliable(qos), IsReliable(qos) && IsTransientLocal(qos));
  {
    const MakingTap making(tap);
    endpoint.shadow = dds_create_reader_rhc(participant, topic, qos, nullptr, &tap->rhc);
  }
  if (endpoint.shadow <= 0) {
    RemoveTap(tap);
    return;
  }
  if (tap->catches_up) EndCatchUp(*tap);
}

void Mirrors::HandleSample(const shm::DdsMessage& message, const std::byte* payload) {
  const auto found = endpoints_.find(Guid::FromBytes(message.subject));
  if (found == endpoints_.end() || found->second.type == nullptr) return;
  Endpoint& endpoint = found->second;
  ddsi_domaingv* gv = DomainOf(endpoint.domain);
  if (gv == nullptr) return;

  const ddsrt_iovec_t bytes{const_cast<std::byte*>(payload), message.payload_size};
  ddsi_serdata* sample =
      ddsi_serdata_from_ser_iov(endpoint.type, static_cast<ddsi_serdata_kind>(message.sample_kind),
                                1, &bytes, message.payload_size);
  if (sample == nullptr) {
    if (!endpoint.warned) {
      const bool is_nodes = endpoint.what.topic == "ros_discovery_info";
      Say("a sample of DDS topic %s cannot be read as %s: the programs' types differ%s",
          endpoint.what.topic.c_str(), endpoint.what.type.c_str(),
          is_nodes ? "; say in the scenario which release of ROS 2 they have, like ros: humble"
                   : "");
    }
    endpoint.warned = true;
    return;
  }
  sample->timestamp.v = message.source_timestamp_ns;
  sample->statusinfo = message.status_info;

  if (std::exchange(endpoint.not_alive, false)) {
    RegainLiveliness(gv, endpoint.inner, ReadersOf(endpoint.domain, endpoint.what.topic));
  }
  const Guid reader = Guid::FromBytes(message.other);
  std::vector<Guid> waiting;
  if (reader.IsZero()) {
    const Forwarding forwarding;
    Real().dds_forwardcdr(endpoint.shadow, ddsi_serdata_ref(sample));
    waiting = forwarding.refused();
  } else {
    waiting = {reader};
  }
  for (const Guid& guid : waiting) {
    while (!StoreIn(gv, guid, endpoint.inner, sample)) dds_sleepfor(kTryAgain);
  }
  ddsi_serdata_unref(sample);
}

void Mirrors::HandleHistoryEnd(const shm::DdsMessage& message) {
  const auto found = endpoints_.find(Guid::FromBytes(message.subject));
  if (found == endpoints_.end() || found->second.shadow <= 0) return;
  ddsi_domaingv* gv = DomainOf(found->second.domain);
  if (gv == nullptr) return;
  const Awake awake(gv);
  const ddsi_guid_t inner = Guid::FromBytes(message.other).Inner();
  const ddsi_reader* reader = entidx_lookup_reader_guid(gv->entity_index, &inner);
  if (reader != nullptr) EndHistory(*reader, found->second.inner);
}

void Mirrors::HandleLiveliness(const shm::DdsMessage& message) {
  const Guid guid = Guid::FromBytes(message.subject);
  if (const auto found = participants_.find(guid); found != participants_.end()) {
    if ((message.flags & shm::kDdsGone) == 0 && found->second.shadow > 0) {
      Real().dds_assert_liveliness(found->second.shadow);
    }
    return;
  }
  const auto found = endpoints_.find(guid);
  if (found == endpoints_.end() || found->second.shadow <= 0) return;
  Endpoint& endpoint = found->second;
  if ((message.flags & shm::kDdsGone) == 0) {
    Real().dds_assert_liveliness(endpoint.shadow);
  } else if (ddsi_domaingv* gv = DomainOf(endpoint.domain); gv != nullptr) {
    endpoint.not_alive = true;
    LoseLiveliness(gv, endpoint.inner, ReadersOf(endpoint.domain, endpoint.what.topic));
  }
}

}  // namespace tcs::dds
