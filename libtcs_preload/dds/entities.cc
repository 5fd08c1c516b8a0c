#include "libtcs_preload/dds/entities.h"

#include "libtcs_preload/dds/announce.h"
#include "libtcs_preload/dds/catch_up.h"
#include "libtcs_preload/dds/identity.h"
#include "libtcs_preload/dds/listening.h"
#include "libtcs_preload/dds/program.h"
#include "libtcs_preload/dds/say.h"
#include "libtcs_preload/dds/tap.h"

namespace tcs::dds {
namespace {

// Shadows are in the same process as what they are to match, so "ignore what is in my process"
// becomes "ignore what is in my participant".
class MatchableQos {
 public:
  explicit MatchableQos(const dds_qos_t* qos) : qos_(qos) {
    dds_ignorelocal_kind_t kind{};
    if (!dds_qget_ignorelocal(qos, &kind) || kind != DDS_IGNORELOCAL_PROCESS) return;
    changed_ = ddsi_xqos_dup(qos);
    dds_qset_ignorelocal(changed_, DDS_IGNORELOCAL_PARTICIPANT);
  }
  ~MatchableQos() {
    if (changed_ != nullptr) dds_delete_qos(changed_);
  }
  MatchableQos(const MatchableQos&) = delete;
  MatchableQos& operator=(const MatchableQos&) = delete;
  const dds_qos_t* get() const { return changed_ != nullptr ? changed_ : qos_; }

 private:
  const dds_qos_t* qos_;
  dds_qos_t* changed_ = nullptr;
};

// Built-in topics are each process's own.
bool IsBuiltin(const ddsi_participant& participant, const ddsi_sertype* type) {
  return builtintopic_is_builtintopic(participant.e.gv->builtin_topic_interface, type);
}

}  // namespace

dds_return_t NewParticipant(ddsi_guid_t* guid, ddsi_domaingv* gv, unsigned flags,
                            const ddsi_plist_t* plist) {
  const dds_return_t result = MakeParticipant(guid, gv, flags, plist);
  if (result < 0 || IsShadow(*guid)) return result;
  const Awake awake(gv);
  const ddsi_participant* made = entidx_lookup_participant_guid(gv->entity_index, guid);
  if (made == nullptr || !LayoutIsAsCompiled(*gv, *made)) {
    Say("this libddsc is not laid out as Debian's %s is: run the program with DDS over sockets",
        DDS_VERSION);
    Real().ddsi_delete_participant(gv, guid);
    return DDS_RETCODE_PRECONDITION_NOT_MET;
  }
  AddParticipant(gv, Guid::Of(*guid));
  AnnounceParticipant(*made);
  return result;
}

dds_return_t DeleteParticipant(ddsi_domaingv* gv, const ddsi_guid_t* guid) {
  const Guid key = Guid::Of(*guid);
  const std::uint32_t domain = gv->config.domainId;
  const bool own = IsParticipant(key);
  if (own) RemoveParticipant(gv, key);
  const dds_return_t result = Real().ddsi_delete_participant(gv, guid);
  if (own) AnnounceGone(shm::DdsKind::kParticipant, domain, key);
  return result;
}

void UpdateParticipant(ddsi_participant* participant, const ddsi_plist_t* plist) {
  Real().ddsi_update_participant_plist(participant, plist);
  if (!IsShadow(participant->e.guid)) AnnounceParticipant(*participant);
}

dds_return_t NewWriter(ddsi_writer** writer, ddsi_guid_t* guid, const ddsi_guid_t* group,
                       ddsi_participant* participant, const char* topic, const ddsi_sertype* type,
                       const dds_qos_t* qos, whc* cache, ddsi_status_cb_t status, void* argument) {
  if (IsShadow(participant->e.guid)) {
    return Real().ddsi_new_writer(writer, guid, group, participant, topic, type, qos, cache, status,
                                  argument);
  }
  const MatchableQos matchable(qos);
  const dds_return_t result =
      Real().ddsi_new_writer(writer, guid, group, participant, topic, type, matchable.get(), cache,
                             ListeningWriterStatus(status), argument);
  if (result >= 0 && !IsBuiltin(*participant, type)) AnnounceWriter(**writer);
  return result;
}

dds_return_t DeleteWriter(ddsi_domaingv* gv, const ddsi_guid_t* guid) {
  const Guid key = Guid::Of(*guid);
  const dds_return_t result = Real().ddsi_delete_writer(gv, guid);
  if (IsWriter(key)) {
    RemoveWriter(gv, key);
    AnnounceGone(shm::DdsKind::kEndpoint, gv->config.domainId, key);
  }
  return result;
}

void UpdateWriter(ddsi_writer* writer, const dds_qos_t* qos) {
  if (!IsWriter(Guid::Of(writer->e.guid))) {
    Real().ddsi_update_writer_qos(writer, qos);
    return;
  }
  const MatchableQos matchable(qos);
  {
    const Matching matching(nullptr);
    Real().ddsi_update_writer_qos(writer, matchable.get());
  }
  AnnounceChange(*writer);
}

dds_return_t NewReader(ddsi_reader** reader, ddsi_guid_t* guid, const ddsi_guid_t* group,
                       ddsi_participant* participant, const char* topic, const ddsi_sertype* type,
                       const dds_qos_t* qos, ddsi_rhc* cache, ddsi_status_cb_t status,
                       void* argument) {
  if (IsShadow(participant->e.guid)) {
    return Real().ddsi_new_reader(reader, guid, group, participant, topic, type, qos, cache, status,
                                  argument);
  }
  const bool builtin = IsBuiltin(*participant, type);
  const MatchableQos matchable(qos);
  if (!builtin) CoverHistoryCache(cache, participant->e.gv, *qos);
  dds_return_t result;
  {
    const MakingReader making;
    result = Real().ddsi_new_reader(reader, guid, group, participant, topic, type, matchable.get(),
                                    cache, ListeningReaderStatus(status), argument);
  }
  if (result >= 0 && !builtin) AnnounceReader(**reader);
  return result;
}

dds_return_t DeleteReader(ddsi_domaingv* gv, const ddsi_guid_t* guid) {
  const Guid key = Guid::Of(*guid);
  const dds_return_t result = Real().ddsi_delete_reader(gv, guid);
  if (RemoveReader(key)) AnnounceGone(shm::DdsKind::kEndpoint, gv->config.domainId, key);
  return result;
}

void UpdateReader(ddsi_reader* reader, const dds_qos_t* qos) {
  if (IsShadow(reader->e.guid)) {
    Real().ddsi_update_reader_qos(reader, qos);
    return;
  }
  const MatchableQos matchable(qos);
  {
    const MakingReader making;
    Real().ddsi_update_reader_qos(reader, matchable.get());
  }
  AnnounceChange(*reader);
}

}  // namespace tcs::dds
