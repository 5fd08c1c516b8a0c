// Other processes' participants and endpoints, each with a shadow in this process that Cyclone
// takes for local: so matching, incompatible QoS and all statuses are Cyclone's own.
//
// A domain here is a network's (program.h): the program may have several of one name, each with its
// own shadows, also of what the program itself has in the others.
//
// A shadow participant is there while the program has a participant in the domain; a shadow
// endpoint once the program has its topic, or looks at all that there is. The shadow endpoint has
// the program's type if that is its original's type, too, and else one that stands for the
// original's type (other_type.h). Shadow writers write what their originals have written; shadow
// readers are taps (tap.h).
//
// For one thread, the deliverer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "libtcs_preload/dds/guid.h"
#include "libtcs_preload/dds/held_messages.h"
#include "libtcs_preload/dds/qos_code.h"
#include "shm/dds_exchange.h"

namespace tcs::dds {

class Mirrors {
 public:
  // Handles one message of another process.
  void Handle(const shm::DdsMessage& message, const std::byte* payload);

  // Makes the shadows that have become possible.
  void Complete();

  // Ends all shadows in a domain, by the program's number of it, in which the program has no
  // participant any more.
  void Close(std::uint32_t domain);

 private:
  struct ShadowTopic {
    std::string name, type;
    TypeCode type_code;
    dds_entity_t entity;
  };
  struct ParticipantShadow {
    dds_entity_t entity = 0;
    std::vector<ShadowTopic> topics;
  };
  struct Participant {
    std::uint32_t domain;
    std::uint32_t process;
    std::uint64_t tag;
    std::int64_t lease_ns;
    bool gone = false;  // only deaf domains still have shadows of it
    Payload payload;
    std::map<std::uint32_t, ParticipantShadow> shadows;  // by the program's number of the domain
  };
  struct EndpointShadow {
    dds_entity_t entity = 0;
    ddsi_guid_t inner{};
    const ddsi_sertype* type = nullptr;
  };
  struct Endpoint {
    Guid participant{};
    std::uint32_t domain;
    std::uint32_t process;
    Payload payload;
    DecodedEndpoint what;
    std::map<std::uint32_t, EndpointShadow> shadows;
    std::map<std::uint32_t, std::int64_t> lost_at_ns;  // by deaf domains, monotonic
    bool gone = false;                                 // only deaf domains still have shadows of it
    bool not_alive = false;  // the lease is over, and the endpoint has not written since
    bool warned = false;
    bool looked_at = false;  // a sample was tried: whether the program's type of that name reads it
  };
  // A topic that is announced by itself; it has no handle in the program.
  struct Topic {
    Guid participant{};
    std::uint32_t domain;
    Payload payload;
    DecodedEndpoint what;
    std::map<std::uint32_t, ddsi_guid_t> shadows;
  };
  // A domain that hears nothing (deaf_mute.h): the domain's shadows are as they were, until the
  // leases of their originals are over.
  struct Deaf {
    std::int64_t since_ns;
    std::int64_t last_lost_ns = INT64_MIN;
    std::set<Guid> lost;  // endpoints
    HeldMessages missed;  // samples, and ends of histories
  };
  using Participants = std::unordered_map<Guid, Participant, GuidHash>;
  using Endpoints = std::unordered_map<Guid, Endpoint, GuidHash>;

  void HandleParticipant(const shm::DdsMessage& message, Payload payload);
  void HandleEndpoint(const shm::DdsMessage& message, Payload payload);
  void HandleTopic(const shm::DdsMessage& message, Payload payload);
  void HandleSample(const shm::DdsMessage& message, const std::byte* payload);
  void HandleHistoryEnd(const shm::DdsMessage& message);
  void HandleLiveliness(const shm::DdsMessage& message);

  void ChangeQos(Endpoint& endpoint, Payload payload);
  static void SetQos(const EndpointShadow& shadow, const Payload& payload);
  bool IsDeaf(std::uint32_t domain) const { return deaf_.contains(domain); }
  void LookAtDeaf(const ddsi_domaingv& gv);
  void EndLeases(const ddsi_domaingv& gv, Deaf& deaf);
  void Hear(std::uint32_t domain);

  void RemoveParticipant(const Guid& guid);
  void RemoveEndpoint(const Guid& guid);
  void EndShadow(const Guid& guid, Participant& participant, std::uint32_t domain);

  void MakeParticipant(const Guid& guid, Participant& participant);
  void MakeParticipantIn(ddsi_domaingv* gv, const Guid& guid, Participant& participant);
  void MakeEndpoint(const Guid& guid, Endpoint& endpoint);
  void MakeEndpointIn(ddsi_domaingv* gv, const Guid& guid, Endpoint& endpoint);
  void MakeTopic(const Guid& guid, Topic& topic);
  void MakeTopicIn(ddsi_domaingv* gv, const Guid& guid, Topic& topic);
  static void EndTopic(Topic& topic);
  static void EndTopicIn(std::uint32_t domain, Topic& topic);
  dds_entity_t TopicOf(ddsi_domaingv* gv, const Endpoint& endpoint, ParticipantShadow& participant,
                       const dds_qos_t* qos);
  static ddsi_sertype* TypeOf(const ddsi_domaingv* gv, const DecodedEndpoint& what);
  EndpointShadow MakeWriter(ddsi_domaingv* gv, dds_entity_t participant, dds_entity_t topic,
                            const dds_qos_t* qos);
  EndpointShadow MakeReader(ddsi_domaingv* gv, const Guid& guid, const Endpoint& endpoint,
                            dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos);
  void MakeAll();
  void Miss(const Guid& guid, const Endpoint& endpoint, const shm::DdsMessage& message,
            const std::byte* payload);
  void HandleSampleIn(std::uint32_t domain, Endpoint& endpoint, const EndpointShadow& shadow,
                      bool was_not_alive, const shm::DdsMessage& message, const std::byte* payload);
  static void HandleHistoryEndIn(std::uint32_t domain, const EndpointShadow& shadow,
                                 const shm::DdsMessage& message);
  void Inject(ddsi_domaingv* gv, Endpoint& endpoint, const EndpointShadow& shadow,
              const shm::DdsMessage& message, const std::byte* payload);

  static void LookAt(const ddsi_domaingv* gv, Endpoint& endpoint, const ddsi_serdata* sample);
  void HoldInstance(ddsi_domaingv* gv, ddsi_serdata* sample);

  std::set<std::uint32_t> held_in_;  // domains, by the program's numbers
  std::map<std::uint32_t, Deaf> deaf_;
  Participants participants_;
  Endpoints endpoints_;
  std::unordered_map<Guid, Topic, GuidHash> topics_;
};

}  // namespace tcs::dds
