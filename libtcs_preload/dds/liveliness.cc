#include "libtcs_preload/dds/liveliness.h"

#include <dds/ddsi/ddsi_entity_match.h>

#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/program.h"

namespace tcs::dds {
namespace {

// Notes in the reader's match whether the writer is alive; false: the writer does not match, or
// that was so already.
bool MarkAlive(ddsi_reader& reader, const ddsi_writer& writer, bool is_alive) {
  ddsrt_mutex_lock(&reader.e.lock);
  auto* match = static_cast<ddsi_rd_wr_match*>(
      ddsrt_avl_lookup(&ddsi_rd_local_writers_treedef, &reader.local_writers, &writer.e.guid));
  const bool changes = match != nullptr && (match->wr_alive != 0) != is_alive;
  if (changes) {
    match->wr_alive = is_alive ? 1 : 0;
    ++match->wr_alive_vclock;
  }
  ddsrt_mutex_unlock(&reader.e.lock);
  return changes;
}

void TellReader(ddsi_reader& reader, const ddsi_writer& writer, bool is_alive) {
  if (!MarkAlive(reader, writer, is_alive)) return;
  if (reader.status_cb != nullptr) {
    ddsi_status_cb_data_t data{};
    data.raw_status_id = DDS_LIVELINESS_CHANGED_STATUS_ID;
    data.extra = is_alive ? DDSI_LIVELINESS_CHANGED_NOT_ALIVE_TO_ALIVE
                          : DDSI_LIVELINESS_CHANGED_ALIVE_TO_NOT_ALIVE;
    data.handle = writer.e.iid;
    reader.status_cb(reader.status_cb_entity, &data);
  }
  if (is_alive) return;
  ddsi_writer_info info;
  ddsi_make_writer_info(&info, &writer.e, writer.xqos, NN_STATUSINFO_UNREGISTER);
  ddsi_rhc_unregister_wr(reader.rhc, &info);
}

void TellReaders(ddsi_domaingv* gv, const ddsi_guid_t& shadow, const std::vector<Guid>& readers,
                 bool is_alive) {
  const Awake awake(gv);
  const ddsi_writer* writer = entidx_lookup_writer_guid(gv->entity_index, &shadow);
  if (writer == nullptr) return;
  for (const Guid& guid : readers) {
    const ddsi_guid_t inner = InnerOf(guid);
    ddsi_reader* reader = entidx_lookup_reader_guid(gv->entity_index, &inner);
    if (reader != nullptr) TellReader(*reader, *writer, is_alive);
  }
}

}  // namespace

void LoseLiveliness(ddsi_domaingv* gv, const ddsi_guid_t& shadow,
                    const std::vector<Guid>& readers) {
  TellReaders(gv, shadow, readers, false);
}

void RegainLiveliness(ddsi_domaingv* gv, const ddsi_guid_t& shadow,
                      const std::vector<Guid>& readers) {
  TellReaders(gv, shadow, readers, true);
}

dds_return_t AssertLiveliness(dds_entity_t entity) {
  const dds_return_t result = Real().dds_assert_liveliness(entity);
  dds_guid_t guid;
  if (result < 0 || dds_get_guid(entity, &guid) != DDS_RETCODE_OK) return result;
  dds_domainid_t domain = 0;
  dds_get_domainid(entity, &domain);
  const Visit visit(domain);
  if (visit.gv() == nullptr) return result;
  shm::DdsMessage message =
      MessageOf(shm::DdsKind::kLiveliness, NetworkDomain(*visit.gv()), GuidAt(guid.v));
  Send(*visit.gv(), message, {});
  return result;
}

}  // namespace tcs::dds
