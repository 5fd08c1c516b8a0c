#include "libtcs_preload/dds/entities.h"

#include "libtcs_preload/dds/announce.h"
#include "libtcs_preload/dds/catch_up.h"
#include "libtcs_preload/dds/deliverer.h"
#include "libtcs_preload/dds/identity.h"
#include "libtcs_preload/dds/ignore_local.h"
#include "libtcs_preload/dds/ignored_partitions.h"
#include "libtcs_preload/dds/listening.h"
#include "libtcs_preload/dds/program.h"
#include "libtcs_preload/dds/say.h"

namespace tcs::dds {
namespace {

// Built-in topics are each process's own.
bool IsBuiltin(const ddsi_participant& participant, const ddsi_sertype* type) {
  return builtintopic_is_builtintopic(participant.e.gv->builtin_topic_interface, type);
}

// The QoS that a shadow is made with: others' endpoints show of which type they are, a program's
// own do not.
class WithTypeInformation {
 public:
  WithTypeInformation(const dds_qos_t* qos, const ddsi_sertype* type) : qos_(ddsi_xqos_dup(qos)) {
    if ((qos_->present & QP_TYPE_INFORMATION) != 0) return;
    qos_->type_information = ddsi_sertype_typeinfo(type);
    if (qos_->type_information != nullptr) qos_->present |= QP_TYPE_INFORMATION;
  }
  ~WithTypeInformation() { dds_delete_qos(qos_); }
  WithTypeInformation(const WithTypeInformation&) = delete;
  WithTypeInformation& operator=(const WithTypeInformation&) = delete;
  const dds_qos_t* get() const { return qos_; }

 private:
  dds_qos_t* qos_;
};

// The matches of an endpoint of the program's that is about to be made; `others`: the endpoints
// that it may match.
OwnMatches MatchesOf(ddsi_domaingv* gv, const char* topic, const dds_qos_t& qos,
                     const std::vector<Guid>& others) {
  const bool is_ignored = IsIgnored(gv->config, topic, qos);
  const auto shadows =
      is_ignored ? ShadowEndpointsOf(gv->config.domainId, topic) : std::vector<Guid>();
  return OwnMatches(gv, &qos, others, shadows, is_ignored);
}

}  // namespace

dds_return_t NewParticipant(ddsi_guid_t* guid, ddsi_domaingv* gv, unsigned flags,
                            const ddsi_plist_t* plist) {
  const dds_return_t result = MakeParticipant(guid, gv, flags, plist);
  if (result < 0 || IsShadow(gv, *guid)) return result;
  const Awake awake(gv);
  const ddsi_participant* made = entidx_lookup_participant_guid(gv->entity_index, guid);
  if (made == nullptr || !LayoutIsAsCompiled(*gv, *made)) {
    Say("this libddsc has another layout than Debian's %s: run the program with DDS over sockets "
        "(dds: sockets)",
        DDS_VERSION);
    Real().ddsi_delete_participant(gv, guid);
    return DDS_RETCODE_PRECONDITION_NOT_MET;
  }
  AddParticipant(gv, GuidOf(*guid));
  AnnounceParticipant(*made);
  return result;
}

dds_return_t DeleteParticipant(ddsi_domaingv* gv, const ddsi_guid_t* guid) {
  const Guid key = GuidOf(*guid);
  const bool own = IsParticipant(gv, key);
  if (own) RemoveParticipant(gv, key);
  const dds_return_t result = Real().ddsi_delete_participant(gv, guid);
  if (own) AnnounceGone(shm::DdsKind::kParticipant, *gv, key);
  return result;
}

void UpdateParticipant(ddsi_participant* participant, const ddsi_plist_t* plist) {
  Real().ddsi_update_participant_plist(participant, plist);
  if (!IsShadow(participant->e.gv, participant->e.guid)) AnnounceParticipant(*participant);
}

dds_return_t NewWriter(ddsi_writer** writer, ddsi_guid_t* guid, const ddsi_guid_t* group,
                       ddsi_participant* participant, const char* topic, const ddsi_sertype* type,
                       const dds_qos_t* qos, whc* cache, ddsi_status_cb_t status, void* argument) {
  if (IsShadow(participant->e.gv, participant->e.guid)) {
    const WithTypeInformation all(qos, type);
    const dds_return_t result = Real().ddsi_new_writer(writer, guid, group, participant, topic,
                                                       type, all.get(), cache, status, argument);
    if (result >= 0) AddShadowEndpoint(participant->e.gv->config.domainId, topic, GuidOf(*guid));
    return result;
  }
  ddsi_domaingv* gv = participant->e.gv;
  OwnMatches matches = MatchesOf(gv, topic, *qos, ReadersOf(gv->config.domainId, topic));
  const dds_return_t result =
      Real().ddsi_new_writer(writer, guid, group, participant, topic, type, matches.qos(), cache,
                             ListeningWriterStatus(status), argument);
  if (result < 0) return result;
  matches.Made(*guid);
  if (!IsBuiltin(*participant, type)) AnnounceWriter(**writer);
  return result;
}

dds_return_t DeleteWriter(ddsi_domaingv* gv, const ddsi_guid_t* guid) {
  const Guid key = GuidOf(*guid);
  const dds_return_t result = Real().ddsi_delete_writer(gv, guid);
  RemoveShadowEndpoint(gv->config.domainId, key);
  if (IsWriter(gv, key)) {
    RemoveWriter(gv, key);
    ForgetIgnoring(key);
    AnnounceGone(shm::DdsKind::kEndpoint, *gv, key);
  }
  return result;
}

void UpdateWriter(ddsi_writer* writer, const dds_qos_t* qos) {
  Real().ddsi_update_writer_qos(writer, qos);
  if (IsWriter(writer->e.gv, GuidOf(writer->e.guid))) AnnounceChange(*writer);
}

dds_return_t NewReader(ddsi_reader** reader, ddsi_guid_t* guid, const ddsi_guid_t* group,
                       ddsi_participant* participant, const char* topic, const ddsi_sertype* type,
                       const dds_qos_t* qos, ddsi_rhc* cache, ddsi_status_cb_t status,
                       void* argument) {
  if (IsShadow(participant->e.gv, participant->e.guid)) {
    const WithTypeInformation all(qos, type);
    const dds_return_t result = Real().ddsi_new_reader(reader, guid, group, participant, topic,
                                                       type, all.get(), cache, status, argument);
    if (result >= 0) AddShadowEndpoint(participant->e.gv->config.domainId, topic, GuidOf(*guid));
    return result;
  }
  ddsi_domaingv* gv = participant->e.gv;
  const bool builtin = IsBuiltin(*participant, type);
  if (!builtin) CoverHistoryCache(cache, gv, *qos);
  if (builtin && LookAround()) LookAgain();
  OwnMatches matches = MatchesOf(gv, topic, *qos, WritersOf(gv->config.domainId, topic));
  dds_return_t result;
  {
    const MakingReader making;
    result = Real().ddsi_new_reader(reader, guid, group, participant, topic, type, matches.qos(),
                                    cache, ListeningReaderStatus(status), argument);
  }
  if (result < 0) return result;
  matches.Made(*guid);
  if (!builtin) {
    NameCover(**reader);
    AnnounceReader(**reader);
  }
  return result;
}

dds_return_t DeleteReader(ddsi_domaingv* gv, const ddsi_guid_t* guid) {
  const Guid key = GuidOf(*guid);
  const dds_return_t result = Real().ddsi_delete_reader(gv, guid);
  RemoveShadowEndpoint(gv->config.domainId, key);
  if (RemoveReader(gv, key)) {
    ForgetIgnoring(key);
    AnnounceGone(shm::DdsKind::kEndpoint, *gv, key);
  }
  return result;
}

void UpdateReader(ddsi_reader* reader, const dds_qos_t* qos) {
  Real().ddsi_update_reader_qos(reader, qos);
  if (!IsShadow(reader->e.gv, reader->e.guid)) AnnounceChange(*reader);
}

// A shadow's topic is there only for its endpoints: the topic must not be found as one that
// somebody has.
dds_return_t NewTopic(ddsi_topic** topic, ddsi_guid_t* guid, ddsi_participant* participant,
                      const char* name, const ddsi_sertype* type, const dds_qos_t* qos,
                      bool is_builtin, bool* is_new) {
  if (!IsShadow(participant->e.gv, participant->e.guid)) {
    const dds_return_t result =
        Real().ddsi_new_topic(topic, guid, participant, name, type, qos, is_builtin, is_new);
    if (result >= 0 && !is_builtin) AnnounceTopic(**topic, type);
    return result;
  }
  *topic = nullptr;
  *guid = {};
  *is_new = false;
  return DDS_RETCODE_OK;
}

void UpdateTopic(ddsi_topic* topic, const dds_qos_t* qos) {
  Real().ddsi_update_topic_qos(topic, qos);
  if (!IsShadow(topic->e.gv, topic->e.guid)) AnnounceChange(*topic);
}

dds_return_t DeleteTopic(ddsi_domaingv* gv, const ddsi_guid_t* guid) {
  const dds_return_t result = Real().ddsi_delete_topic(gv, guid);
  if (result >= 0 && MakesTopicsKnown(*gv) && !IsShadow(gv, *guid)) {
    AnnounceGone(shm::DdsKind::kTopic, *gv, GuidOf(*guid));
  }
  return result;
}

}  // namespace tcs::dds
