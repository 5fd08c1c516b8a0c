#include "libtcs_preload/dds/announce.h"

#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/program.h"
#include "libtcs_preload/dds/tap.h"

namespace tcs::dds {
namespace {

// Sets the lease for the coordinator: the time that automatic liveliness lasts when nobody renews
// it. Manual liveliness runs out in each reader's process by itself.
void SetLease(shm::DdsMessage& message, std::int64_t lease_ns) {
  if (lease_ns == DDS_INFINITY) return;
  message.lease_ns = lease_ns;
  message.flags |= shm::kDdsLeased;
}

// An endpoint that is of this process only is nobody else's concern (ignored_partitions.h).
template <class Entity>
void SendEndpoint(const Entity& entity, std::uint32_t kind) {
  if (entity.e.onlylocal) return;
  const dds_qos_t& qos = *entity.xqos;
  shm::DdsMessage message =
      MessageOf(shm::DdsKind::kEndpoint, NetworkDomain(*entity.e.gv), GuidOf(entity.e.guid));
  PutGuid(GuidOf(entity.c.pp->e.guid), message.other);
  if (kind == shm::kDdsWriter && qos.liveliness.kind == DDS_LIVELINESS_AUTOMATIC) {
    SetLease(message, qos.liveliness.lease_duration);
  }
  Send(*entity.e.gv, message, EncodeEndpoint(kind, qos.topic_name, entity.type, &qos));
}

// Tells readers of other processes that expect what the writer has: the writer has sent all, or has
// nothing.
void EndHistories(const ddsi_writer& writer) {
  if (writer.e.onlylocal || writer.xqos->durability.kind < DDS_DURABILITY_TRANSIENT_LOCAL) return;
  const ddsi_domaingv& gv = *writer.e.gv;
  for (const LateReader& reader : ReadersThatCatchUp(gv.config.domainId, writer.xqos->topic_name)) {
    SendHistoryEnd(gv, GuidOf(writer.e.guid), reader.guid, reader.process);
  }
}

}  // namespace

void AnnounceParticipant(const ddsi_participant& participant) {
  shm::DdsMessage message = MessageOf(shm::DdsKind::kParticipant, NetworkDomain(*participant.e.gv),
                                      GuidOf(participant.e.guid));
  SetLease(message, participant.lease_duration);
  message.instance = shm::DdsTag(participant.e.gv->config.domainTag);
  Send(*participant.e.gv, message, EncodeParticipant(&participant.plist->qos));
}

void AnnounceWriter(const ddsi_writer& writer) {
  if (!AddWriter(writer)) return;
  SendEndpoint(writer, shm::kDdsWriter);
  EndHistories(writer);
}

bool MakesTopicsKnown(const ddsi_domaingv& gv) {
  return gv.config.enable_topic_discovery_endpoints != 0;
}

void AnnounceTopic(const ddsi_topic& topic, const ddsi_sertype* type) {
  if (!MakesTopicsKnown(*topic.e.gv)) return;
  const dds_qos_t& qos = *topic.definition->xqos;
  shm::DdsMessage message =
      MessageOf(shm::DdsKind::kTopic, NetworkDomain(*topic.e.gv), GuidOf(topic.e.guid));
  PutGuid(GuidOf(topic.pp->e.guid), message.other);
  Send(*topic.e.gv, message, EncodeEndpoint(shm::kDdsTopic, qos.topic_name, type, &qos));
}

void AnnounceReader(const ddsi_reader& reader) {
  AddReader(reader);
  SendEndpoint(reader, shm::kDdsReader);
}

void AnnounceChange(const ddsi_writer& writer) { SendEndpoint(writer, shm::kDdsWriter); }

void AnnounceChange(const ddsi_reader& reader) { SendEndpoint(reader, shm::kDdsReader); }

// The topic's type is as it was; the topic itself does not have it.
void AnnounceChange(const ddsi_topic& topic) {
  if (!MakesTopicsKnown(*topic.e.gv)) return;
  const dds_qos_t& qos = *topic.definition->xqos;
  if (ddsi_sertype* type = ReferType(topic.e.gv->config.domainId, qos.topic_name, qos.type_name)) {
    AnnounceTopic(topic, type);
    ddsi_sertype_unref(type);
  }
}

void AnnounceGone(shm::DdsKind kind, const ddsi_domaingv& gv, const Guid& guid) {
  shm::DdsMessage message = MessageOf(kind, NetworkDomain(gv), guid);
  message.flags = shm::kDdsGone;
  Send(gv, message, {});
}

}  // namespace tcs::dds
