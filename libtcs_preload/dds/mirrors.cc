#include "libtcs_preload/dds/mirrors.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "libtcs_preload/dds/announce.h"
#include "libtcs_preload/dds/catch_up.h"
#include "libtcs_preload/dds/deaf_mute.h"
#include "libtcs_preload/dds/identity.h"
#include "libtcs_preload/dds/ignore_local.h"
#include "libtcs_preload/dds/liveliness.h"
#include "libtcs_preload/dds/muting.h"
#include "libtcs_preload/dds/other_type.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/own_news.h"
#include "libtcs_preload/dds/program.h"
#include "libtcs_preload/dds/say.h"
#include "libtcs_preload/dds/shadow_qos.h"
#include "libtcs_preload/dds/tap.h"

namespace tcs::dds {
namespace {

// How often a reader that is full is tried, as by Cyclone's own threads.
constexpr dds_duration_t kTryAgain = DDS_MSECS(1);

// False: the reader is full.
bool StoreIn(ddsi_domaingv* gv, const Guid& guid, const ddsi_guid_t& shadow_guid,
             ddsi_serdata* sample) {
  const Awake awake(gv);
  const ddsi_guid_t inner = InnerOf(guid);
  const ddsi_reader* reader = entidx_lookup_reader_guid(gv->entity_index, &inner);
  const ddsi_writer* shadow = entidx_lookup_writer_guid(gv->entity_index, &shadow_guid);
  return reader == nullptr || shadow == nullptr || StoreAddressed(*reader, *shadow, sample);
}

template <class Map>
std::vector<typename Map::key_type> KeysOf(const Map& map) {
  std::vector<typename Map::key_type> keys;
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

// Takes the type over.
dds_entity_t CreateTopicOf(dds_entity_t participant, const std::string& name, ddsi_sertype* type,
                           const dds_qos_t* qos) {
  ddsi_sertype* consumed = type;
  const dds_entity_t topic = Real().dds_create_topic_impl(participant, name.c_str(), false,
                                                          &consumed, qos, nullptr, nullptr, false);
  if (topic <= 0) ddsi_sertype_unref(type);
  return topic;
}

void SayUnreadable(const DecodedEndpoint& what, bool has_been_said) {
  if (has_been_said) return;
  const bool is_nodes = what.topic == "ros_discovery_info";
  Say("a sample of DDS topic %s cannot be read as %s: the programs' types differ%s",
      what.topic.c_str(), what.type.c_str(),
      is_nodes ? "; name the release of ROS 2 in the scenario, as in ros: humble" : "");
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
    case shm::DdsKind::kTopic:
      HandleTopic(message, Payload(payload, payload + message.payload_size));
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
  const Guid guid = GuidAt(message.subject);
  if ((message.flags & shm::kDdsGone) != 0) {
    RemoveParticipant(guid);
    return;
  }
  Participant& participant = participants_[guid];
  const bool changed = !participant.shadows.empty() && participant.payload != payload;
  participant.domain = message.domain;
  participant.process = message.from;
  participant.tag = message.instance;
  participant.lease_ns = message.lease_ns;
  participant.gone = false;
  participant.payload = std::move(payload);
  if (changed) {
    const Qos qos(DecodeQos(participant.payload, true));
    for (auto& [domain, shadow] : participant.shadows) {
      if (!IsDeaf(domain)) dds_set_qos(shadow.entity, qos.get());
    }
  }
  MakeParticipant(guid, participant);
}

void Mirrors::HandleEndpoint(const shm::DdsMessage& message, Payload payload) {
  const Guid guid = GuidAt(message.subject);
  if ((message.flags & shm::kDdsGone) != 0) {
    RemoveEndpoint(guid);
    return;
  }
  Endpoint& endpoint = endpoints_[guid];
  endpoint.gone = false;
  if (!endpoint.shadows.empty()) {
    if (endpoint.payload != payload) ChangeQos(endpoint, std::move(payload));
    MakeEndpoint(guid, endpoint);
    return;
  }
  endpoint.participant = GuidAt(message.other);
  endpoint.domain = message.domain;
  endpoint.process = message.from;
  endpoint.payload = std::move(payload);
  endpoint.what = DecodeEndpoint(endpoint.payload);
  MakeEndpoint(guid, endpoint);
}

void Mirrors::HandleTopic(const shm::DdsMessage& message, Payload payload) {
  const Guid guid = GuidAt(message.subject);
  Topic& topic = topics_[guid];
  if ((message.flags & shm::kDdsGone) != 0) {
    EndTopic(topic);
    topics_.erase(guid);
    return;
  }
  if (topic.payload != payload) {
    EndTopic(topic);
    topic.payload = std::move(payload);
    topic.what = DecodeEndpoint(topic.payload);
  }
  topic.participant = GuidAt(message.other);
  topic.domain = message.domain;
  MakeTopic(guid, topic);
}

// With the program's last participant Cyclone ends the topics of shadows itself.
void Mirrors::EndTopicIn(std::uint32_t domain, Topic& topic) {
  const auto found = topic.shadows.find(domain);
  if (found == topic.shadows.end()) return;
  const Visit visit(domain);
  if (ddsi_domaingv* gv = visit.gv()) {
    const Awake awake(gv);
    Real().ddsi_delete_topic(gv, &found->second);
  }
  topic.shadows.erase(found);
}

void Mirrors::EndTopic(Topic& topic) {
  while (!topic.shadows.empty()) EndTopicIn(topic.shadows.begin()->first, topic);
}

// Some policies are the publisher's, the subscriber's or the topic's, which would refuse the
// endpoint's other policies.
void Mirrors::ChangeQos(Endpoint& endpoint, Payload payload) {
  endpoint.payload = std::move(payload);
  for (const auto& [domain, shadow] : endpoint.shadows) {
    if (!IsDeaf(domain)) SetQos(shadow, endpoint.payload);
  }
}

void Mirrors::SetQos(const EndpointShadow& shadow, const Payload& payload) {
  const Qos qos(ShadowQos(payload));
  const Qos of_topic(dds_create_qos()), of_group(dds_create_qos());
  CopyTopicData(qos.get(), of_topic.get());
  CopyGroupData(qos.get(), of_group.get());
  dds_set_qos(dds_get_topic(shadow.entity), of_topic.get());
  dds_set_qos(dds_get_parent(shadow.entity), of_group.get());
  dds_set_qos(shadow.entity, qos.get());
}

void Mirrors::RemoveParticipant(const Guid& guid) {
  const auto found = participants_.find(guid);
  if (found == participants_.end()) return;
  Participant& participant = found->second;
  for (const std::uint32_t domain : KeysOf(participant.shadows)) {
    if (!IsDeaf(domain)) EndShadow(guid, participant, domain);
  }
  participant.gone = true;
  if (!participant.shadows.empty()) return;
  participants_.erase(found);
  std::erase_if(topics_, [&guid](const auto& topic) { return topic.second.participant == guid; });
  std::erase_if(endpoints_,
                [&guid](const auto& endpoint) { return endpoint.second.participant == guid; });
}

void Mirrors::RemoveEndpoint(const Guid& guid) {
  const auto found = endpoints_.find(guid);
  if (found == endpoints_.end()) return;
  Endpoint& endpoint = found->second;
  for (const std::uint32_t domain : KeysOf(endpoint.shadows)) {
    if (IsDeaf(domain)) continue;
    const dds_entity_t shadow = endpoint.shadows[domain].entity;
    endpoint.shadows.erase(domain);
    Real().dds_delete(shadow);
  }
  endpoint.gone = true;
  if (endpoint.shadows.empty()) endpoints_.erase(guid);
}

void Mirrors::EndShadow(const Guid& guid, Participant& participant, std::uint32_t domain) {
  const auto found = participant.shadows.find(domain);
  if (found == participant.shadows.end()) return;
  const dds_entity_t shadow = found->second.entity;
  participant.shadows.erase(found);
  for (auto& [key, endpoint] : endpoints_) {
    if (endpoint.participant == guid) endpoint.shadows.erase(domain);
  }
  for (auto& [key, topic] : topics_) {
    if (topic.participant == guid) EndTopicIn(domain, topic);
  }
  Real().dds_delete(shadow);
  RemoveShadow(domain, guid);
}

void Mirrors::Complete() {
  for (const std::uint32_t domain : Domains()) {
    const Visit visit(domain);
    if (visit.gv() == nullptr) continue;
    LookAtMute(*visit.gv());
    LookAtDeaf(*visit.gv());
  }
  for (const OwnNews& news : NewsForItself()) {
    Handle(news.message, news.payload.data());
  }
  MakeAll();
}

void Mirrors::MakeAll() {
  for (auto& [guid, participant] : participants_) MakeParticipant(guid, participant);
  for (auto& [guid, topic] : topics_) MakeTopic(guid, topic);
  for (auto& [guid, endpoint] : endpoints_) MakeEndpoint(guid, endpoint);
}

void Mirrors::Close(std::uint32_t domain) {
  // The program may have made another participant meanwhile: in the same domain, or, if that has
  // been taken down with all shadows, in a new domain of its number.
  const bool goes_on = HasDomain(domain);
  for (auto& [guid, participant] : participants_) {
    const auto found = participant.shadows.find(domain);
    if (found == participant.shadows.end()) continue;
    if (!goes_on || dds_get_participant(found->second.entity) <= 0) {
      EndShadow(guid, participant, domain);
    }
  }
  if (goes_on) return;
  held_in_.erase(domain);
  deaf_.erase(domain);
  EndMute(domain);
}

void Mirrors::LookAtDeaf(const ddsi_domaingv& gv) {
  const std::uint32_t domain = gv.config.domainId;
  const std::int64_t now_ns = TheLink().now();
  if (gv.deaf != 0) {
    const auto [place, is_new] = deaf_.try_emplace(domain, Deaf{now_ns, INT64_MIN, {}, {}});
    if (is_new) {
      for (const auto& [guid, participant] : participants_) {
        if (participant.shadows.contains(domain)) WakeAfter(gv, participant.lease_ns);
      }
      if (gv.config.initial_deaf != 0) WakeAfter(gv, gv.config.initial_deaf_mute_reset);
    }
    return EndLeases(gv, place->second);
  }
  const auto found = deaf_.find(domain);
  if (found == deaf_.end()) return;
  const std::int64_t last_lost_ns = found->second.last_lost_ns;
  if (last_lost_ns != INT64_MIN && now_ns - last_lost_ns < kRediscovery) {
    return WakeAfter(gv, kRediscovery - (now_ns - last_lost_ns));
  }
  Hear(domain);
}

// A participant that has not been heard of for as long as its lease is gone, as far as a deaf
// domain can tell.
void Mirrors::EndLeases(const ddsi_domaingv& gv, Deaf& deaf) {
  const std::int64_t now_ns = TheLink().now();
  for (auto place = participants_.begin(); place != participants_.end();) {
    const Guid guid = place->first;
    Participant& participant = (place++)->second;
    if (!participant.shadows.contains(gv.config.domainId)) continue;
    const bool is_over = participant.lease_ns <= now_ns - deaf.since_ns;
    if (!IsToBeLost(gv.config.domainId, guid) && !is_over) continue;
    deaf.last_lost_ns = now_ns;
    for (auto& [key, endpoint] : endpoints_) {
      if (endpoint.participant != guid || !endpoint.shadows.contains(gv.config.domainId)) continue;
      deaf.lost.insert(key);
      endpoint.lost_at_ns[gv.config.domainId] = ddsrt_time_monotonic().v;
    }
    EndShadow(guid, participant, gv.config.domainId);
    if (participant.gone) RemoveParticipant(guid);
  }
}

// Catches up with what others have told the domain, and what reliable writers have written.
void Mirrors::Hear(std::uint32_t domain) {
  const Deaf was = std::move(deaf_.extract(domain).mapped());
  std::vector<Guid> gone_participants, gone_endpoints;
  for (auto& [guid, endpoint] : endpoints_) {
    if (endpoint.gone) gone_endpoints.push_back(guid);
    const auto found = endpoint.shadows.find(domain);
    if (found != endpoint.shadows.end()) SetQos(found->second, endpoint.payload);
  }
  for (auto& [guid, participant] : participants_) {
    if (participant.gone) gone_participants.push_back(guid);
    const auto found = participant.shadows.find(domain);
    if (found == participant.shadows.end()) continue;
    dds_set_qos(found->second.entity, Qos(DecodeQos(participant.payload, true)).get());
  }
  for (const Guid& guid : gone_endpoints) RemoveEndpoint(guid);
  for (const Guid& guid : gone_participants) RemoveParticipant(guid);
  MakeAll();
  for (const HeldMessage& missed : was.missed.all()) {
    const auto found = endpoints_.find(GuidAt(missed.message.subject));
    if (found == endpoints_.end()) continue;
    const auto shadow = found->second.shadows.find(domain);
    if (shadow == found->second.shadows.end()) continue;
    if (missed.message.kind == shm::DdsKind::kSample) {
      HandleSampleIn(domain, found->second, shadow->second, false, missed.message,
                     missed.payload.data());
    } else {
      HandleHistoryEndIn(domain, shadow->second, missed.message);
    }
  }
}

// The message is missed by deaf domains that have, or had, a shadow of the endpoint.
void Mirrors::Miss(const Guid& guid, const Endpoint& endpoint, const shm::DdsMessage& message,
                   const std::byte* payload) {
  for (auto& [domain, deaf] : deaf_) {
    if (!endpoint.shadows.contains(domain) && !deaf.lost.contains(guid)) continue;
    deaf.missed.Add(message, payload, message.payload_size);
  }
}

void Mirrors::MakeParticipant(const Guid& guid, Participant& participant) {
  for (const std::uint32_t domain : DomainsCalled(participant.domain)) {
    const Visit visit(domain);
    if (visit.gv() != nullptr) MakeParticipantIn(visit.gv(), guid, participant);
  }
}

void Mirrors::MakeParticipantIn(ddsi_domaingv* gv, const Guid& guid, Participant& participant) {
  const std::uint32_t domain = gv->config.domainId;
  if (participant.gone || IsDeaf(domain)) return;
  if (participant.shadows.contains(domain) || IsOrWasParticipant(gv, guid)) return;
  if (participant.process != shm::kDdsCoordinator &&
      participant.tag != shm::DdsTag(gv->config.domainTag)) {
    return;
  }
  AddShadow(domain, guid);
  const Qos qos(DecodeQos(participant.payload, true));
  const MakingShadow making(guid);
  const dds_entity_t shadow = Real().dds_create_participant(domain, qos.get(), nullptr);
  if (shadow > 0) {
    participant.shadows[domain].entity = shadow;
    return;
  }
  RemoveShadow(domain, guid);
  Say("cannot mirror a DDS participant of another program: %s", dds_strretcode(shadow));
}

void Mirrors::MakeEndpoint(const Guid& guid, Endpoint& endpoint) {
  if (endpoint.what.topic.empty()) return;
  for (const std::uint32_t domain : DomainsCalled(endpoint.domain)) {
    const Visit visit(domain);
    if (visit.gv() != nullptr) MakeEndpointIn(visit.gv(), guid, endpoint);
  }
}

void Mirrors::MakeEndpointIn(ddsi_domaingv* gv, const Guid& guid, Endpoint& endpoint) {
  const std::uint32_t domain = gv->config.domainId;
  if (endpoint.gone || IsDeaf(domain) || endpoint.shadows.contains(domain)) return;
  const auto owner = participants_.find(endpoint.participant);
  if (owner == participants_.end() || !owner->second.shadows.contains(domain)) return;
  ParticipantShadow& participant = owner->second.shadows[domain];
  const Qos qos(ShadowQos(endpoint.payload));
  const dds_entity_t topic = TopicOf(gv, endpoint, participant, qos.get());
  if (topic <= 0) return;
  SetNextEntity(gv, endpoint.participant, guid);
  const ShadowMatches matches(gv);
  const EndpointShadow shadow =
      endpoint.what.kind == shm::kDdsWriter
          ? MakeWriter(gv, participant.entity, topic, qos.get())
          : MakeReader(gv, guid, endpoint, participant.entity, topic, qos.get());
  if (shadow.entity > 0) {
    endpoint.shadows[domain] = shadow;
  } else if (!endpoint.warned) {
    endpoint.warned = true;
    Say("cannot mirror a %s of DDS topic %s of another program: %s",
        endpoint.what.kind == shm::kDdsWriter ? "writer" : "reader", endpoint.what.topic.c_str(),
        dds_strretcode(shadow.entity));
  }
}

void Mirrors::MakeTopic(const Guid& guid, Topic& topic) {
  if (topic.what.topic.empty()) return;
  for (const std::uint32_t domain : DomainsCalled(topic.domain)) {
    const Visit visit(domain);
    if (visit.gv() != nullptr) MakeTopicIn(visit.gv(), guid, topic);
  }
}

// Where the program's configuration asks for others' topics as well.
void Mirrors::MakeTopicIn(ddsi_domaingv* gv, const Guid& guid, Topic& topic) {
  const std::uint32_t domain = gv->config.domainId;
  const auto owner = participants_.find(topic.participant);
  if (IsDeaf(domain) || topic.shadows.contains(domain) || !MakesTopicsKnown(*gv)) return;
  if (owner == participants_.end() || !owner->second.shadows.contains(domain)) return;
  SetNextEntity(gv, topic.participant, guid);
  const Qos qos(DecodeQos(topic.payload, false));
  const Awake awake(gv);
  const ddsi_guid_t participant_guid = InnerOf(topic.participant);
  ddsi_participant* participant =
      entidx_lookup_participant_guid(gv->entity_index, &participant_guid);
  if (participant == nullptr) return;
  const DecodedEndpoint& what = topic.what;
  ddsi_sertype* type = NewOtherType(what.type, what.keyless, what.type_code);
  ddsi_topic* made = nullptr;
  ddsi_guid_t inner;
  bool is_new = false;
  if (Real().ddsi_new_topic(&made, &inner, participant, what.topic.c_str(), type, qos.get(), false,
                            &is_new) >= 0) {
    topic.shadows[domain] = inner;
  }
  ddsi_sertype_unref(type);
  if (!is_new) return;
  // A thread that looks for a topic waits for this.
  ddsrt_mutex_lock(&gv->new_topic_lock);
  ++gv->new_topic_version;
  ddsrt_cond_broadcast(&gv->new_topic_cond);
  ddsrt_mutex_unlock(&gv->new_topic_lock);
}

// The program's own type if it is the same; null: the program does not look at the topic.
ddsi_sertype* Mirrors::TypeOf(const ddsi_domaingv* gv, const DecodedEndpoint& what) {
  const std::uint32_t domain = gv->config.domainId;
  if (ddsi_sertype* own = ReferType(domain, what.topic, what.type)) {
    if (IsOfType(own, what.type_code)) return own;
    ddsi_sertype_unref(own);
  }
  if (!LooksAround() && !HasTopic(domain, what.topic)) return nullptr;
  return NewOtherType(what.type, what.keyless, what.type_code);
}

// 0: the program does not look at the topic.
dds_entity_t Mirrors::TopicOf(ddsi_domaingv* gv, const Endpoint& endpoint,
                              ParticipantShadow& participant, const dds_qos_t* qos) {
  const DecodedEndpoint& what = endpoint.what;
  const auto found = std::ranges::find_if(participant.topics, [&what](const ShadowTopic& topic) {
    return topic.name == what.topic && topic.type == what.type && topic.type_code == what.type_code;
  });
  if (found != participant.topics.end()) return found->entity;
  ddsi_sertype* type = TypeOf(gv, what);
  if (type == nullptr) return 0;
  // Topics of one name have the same QoS, which that of other types suits, whatever it is.
  const Qos topic_qos(dds_create_qos());
  const auto first = std::ranges::find(participant.topics, what.topic, &ShadowTopic::name);
  if (first != participant.topics.end()) {
    dds_get_qos(first->entity, topic_qos.get());
  } else {
    CopyTopicData(qos, topic_qos.get());
  }
  SetNextEntityOutOfTheWay(gv, endpoint.participant);
  dds_entity_t topic = CreateTopicOf(participant.entity, what.topic, type, topic_qos.get());
  if (topic <= 0 && first != participant.topics.end()) {
    type = NewOtherType(what.type, what.keyless, what.type_code);
    topic = CreateTopicOf(participant.entity, what.topic, type, topic_qos.get());
  }
  if (topic <= 0) {
    Say("cannot mirror DDS topic %s: %s", what.topic.c_str(), dds_strretcode(topic));
    return topic;
  }
  participant.topics.push_back({what.topic, what.type, what.type_code, topic});
  return topic;
}

Mirrors::EndpointShadow Mirrors::MakeWriter(ddsi_domaingv* gv, dds_entity_t participant,
                                            dds_entity_t topic, const dds_qos_t* qos) {
  EndpointShadow shadow;
  shadow.entity = dds_create_writer(participant, topic, qos, nullptr);
  dds_guid_t wire;
  if (shadow.entity <= 0 || dds_get_guid(shadow.entity, &wire) != DDS_RETCODE_OK) return shadow;
  shadow.inner = InnerOf(GuidAt(wire.v));
  const Awake awake(gv);
  const ddsi_writer* writer = entidx_lookup_writer_guid(gv->entity_index, &shadow.inner);
  shadow.type = writer != nullptr ? writer->type : nullptr;
  return shadow;
}

Mirrors::EndpointShadow Mirrors::MakeReader(ddsi_domaingv* gv, const Guid& guid,
                                            const Endpoint& endpoint, dds_entity_t participant,
                                            dds_entity_t topic, const dds_qos_t* qos) {
  EndpointShadow shadow;
  Tap* tap = NewTap(gv, gv->config.domainId, endpoint.process, guid, endpoint.what.topic,
                    IsReliable(qos), IsReliable(qos) && IsTransientLocal(qos));
  const auto lost = endpoint.lost_at_ns.find(gv->config.domainId);
  if (lost != endpoint.lost_at_ns.end()) tap->lost_at_ns = lost->second;
  {
    const MakingTap making(tap);
    shadow.entity = dds_create_reader_rhc(participant, topic, qos, nullptr, &tap->rhc);
  }
  if (shadow.entity <= 0) {
    RemoveTap(tap);
  } else if (tap->catches_up) {
    EndCatchUp(*tap);
  }
  return shadow;
}

void Mirrors::HandleSample(const shm::DdsMessage& message, const std::byte* payload) {
  const auto found = endpoints_.find(GuidAt(message.subject));
  if (found == endpoints_.end()) return;
  Endpoint& endpoint = found->second;
  Miss(found->first, endpoint, message, payload);
  const bool was_not_alive = std::exchange(endpoint.not_alive, false);
  // Listeners do not reach in here: no shadow goes meanwhile.
  for (const auto& [domain, shadow] : endpoint.shadows) {
    if (IsDeaf(domain)) continue;
    HandleSampleIn(domain, endpoint, shadow, was_not_alive, message, payload);
  }
}

void Mirrors::HandleSampleIn(std::uint32_t domain, Endpoint& endpoint, const EndpointShadow& shadow,
                             bool was_not_alive, const shm::DdsMessage& message,
                             const std::byte* payload) {
  const Visit visit(domain);
  ddsi_domaingv* gv = visit.gv();
  if (gv == nullptr || shadow.type == nullptr) return;
  if (was_not_alive) {
    RegainLiveliness(gv, shadow.inner, ReadersOf(domain, endpoint.what.topic));
  }
  Inject(gv, endpoint, shadow, message, payload);
}

void Mirrors::Inject(ddsi_domaingv* gv, Endpoint& endpoint, const EndpointShadow& shadow,
                     const shm::DdsMessage& message, const std::byte* payload) {
  const ddsrt_iovec_t bytes{const_cast<std::byte*>(payload), message.payload_size};
  ddsi_serdata* sample =
      ddsi_serdata_from_ser_iov(shadow.type, static_cast<ddsi_serdata_kind>(message.sample_kind), 1,
                                &bytes, message.payload_size);
  if (sample == nullptr) {
    SayUnreadable(endpoint.what, std::exchange(endpoint.warned, true));
    return;
  }
  sample->timestamp.v = message.source_timestamp_ns;
  sample->statusinfo = message.status_info;
  if (IsOfOtherType(sample)) {
    HoldInstance(gv, sample);
    LookAt(gv, endpoint, sample);
  }

  const Guid reader = GuidAt(message.other);
  std::vector<Guid> waiting;
  if (reader == Guid{}) {
    const Forwarding forwarding;
    Real().dds_forwardcdr(shadow.entity, ddsi_serdata_ref(sample));
    waiting = forwarding.refused();
  } else {
    waiting = {reader};
  }
  for (const Guid& guid : waiting) {
    while (!IsEnding(gv->config.domainId) && !StoreIn(gv, guid, shadow.inner, sample)) {
      dds_sleepfor(kTryAgain);
    }
  }
  ddsi_serdata_unref(sample);
}

// Types without XTypes are compared by their names only.
void Mirrors::LookAt(const ddsi_domaingv* gv, Endpoint& endpoint, const ddsi_serdata* sample) {
  const DecodedEndpoint& what = endpoint.what;
  if (endpoint.looked_at || !what.type_code.information.empty()) return;
  ddsi_sertype* own = ReferType(gv->config.domainId, what.topic, what.type);
  if (own == nullptr) return;
  endpoint.looked_at = true;
  if (ddsi_serdata* read = ddsi_serdata_ref_as_type(own, const_cast<ddsi_serdata*>(sample))) {
    ddsi_serdata_unref(read);
  } else {
    SayUnreadable(what, std::exchange(endpoint.warned, true));
  }
  ddsi_sertype_unref(own);
}

// Samples of others' types are all one instance, which Cyclone would otherwise make and collect for
// each of them. The instance goes with the domain.
void Mirrors::HoldInstance(ddsi_domaingv* gv, ddsi_serdata* sample) {
  if (!held_in_.insert(gv->config.domainId).second) return;
  const Awake awake(gv);
  static_cast<void>(ddsi_tkmap_lookup_instance_ref(gv->m_tkmap, sample));
}

void Mirrors::HandleHistoryEnd(const shm::DdsMessage& message) {
  const auto found = endpoints_.find(GuidAt(message.subject));
  if (found == endpoints_.end()) return;
  Miss(found->first, found->second, message, nullptr);
  for (const auto& [domain, shadow] : found->second.shadows) {
    if (!IsDeaf(domain)) HandleHistoryEndIn(domain, shadow, message);
  }
}

void Mirrors::HandleHistoryEndIn(std::uint32_t domain, const EndpointShadow& shadow,
                                 const shm::DdsMessage& message) {
  const Visit visit(domain);
  const ddsi_domaingv* gv = visit.gv();
  if (gv == nullptr) return;
  const Awake awake(gv);
  const ddsi_guid_t inner = InnerOf(GuidAt(message.other));
  const ddsi_reader* reader = entidx_lookup_reader_guid(gv->entity_index, &inner);
  if (reader != nullptr) EndHistory(*reader, shadow.inner);
}

void Mirrors::HandleLiveliness(const shm::DdsMessage& message) {
  const Guid guid = GuidAt(message.subject);
  if (const auto found = participants_.find(guid); found != participants_.end()) {
    if ((message.flags & shm::kDdsGone) != 0) return;
    for (const auto& [domain, shadow] : found->second.shadows) {
      if (!IsDeaf(domain)) Real().dds_assert_liveliness(shadow.entity);
    }
    return;
  }
  const auto found = endpoints_.find(guid);
  if (found == endpoints_.end()) return;
  Endpoint& endpoint = found->second;
  for (const auto& [domain, shadow] : endpoint.shadows) {
    if (IsDeaf(domain)) continue;
    if ((message.flags & shm::kDdsGone) == 0) {
      Real().dds_assert_liveliness(shadow.entity);
      continue;
    }
    const Visit visit(domain);
    if (visit.gv() == nullptr) continue;
    endpoint.not_alive = true;
    LoseLiveliness(visit.gv(), shadow.inner, ReadersOf(domain, endpoint.what.topic));
  }
}

}  // namespace tcs::dds
