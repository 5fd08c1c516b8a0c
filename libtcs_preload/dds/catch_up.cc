#include "libtcs_preload/dds/catch_up.h"

#include <mutex>
#include <unordered_map>

#include "libtcs_preload/dds/program.h"

namespace tcs::dds {

void Refuse(const Guid& reader);

namespace {

thread_local int t_making_readers;
thread_local Forwarding* t_forwarding;

// A cover is found from a covered cache by the cache's operations, which are the cover's own copy.
struct Cover {
  dds_rhc_ops operations;  // first
  const dds_rhc_ops* real;
  ddsi_domaingv* gv;
  Guid reader{};
  bool has_history;        // transient local
  bool waits_for_history;  // and reliable
  std::mutex mutex;
  // Shadow writers that this reader has met: whether their history has ended.
  std::unordered_map<Guid, bool, GuidHash> caught_up;
};

bool Store(ddsi_rhc* rhc, const ddsi_writer_info* info, ddsi_serdata* sample,
           ddsi_tkmap_instance* instance);

Cover* CoverOf(ddsi_rhc* rhc) {
  return rhc->ops->store == Store ? const_cast<Cover*>(reinterpret_cast<const Cover*>(rhc->ops))
                                  : nullptr;
}

bool HasHistory(const ddsi_domaingv& gv, const ddsi_guid_t& guid) {
  const ddsi_writer* writer = entidx_lookup_writer_guid(gv.entity_index, &guid);
  return writer != nullptr && writer->xqos->durability.kind >= DDS_DURABILITY_TRANSIENT_LOCAL;
}

bool IsDropped(Cover& cover, const ddsi_guid_t& writer) {
  if (!cover.has_history || (t_making_readers == 0 && !cover.waits_for_history)) return false;
  if (!IsShadow(cover.gv, writer)) return false;
  if (!cover.waits_for_history) return true;
  const std::lock_guard lock(cover.mutex);
  const auto [place, is_new] = cover.caught_up.try_emplace(GuidOf(writer));
  if (is_new) place->second = !HasHistory(*cover.gv, writer);
  return !place->second;
}

bool Store(ddsi_rhc* rhc, const ddsi_writer_info* info, ddsi_serdata* sample,
           ddsi_tkmap_instance* instance) {
  Cover& cover = *CoverOf(rhc);
  if (IsDropped(cover, info->guid)) return true;
  if (cover.real->rhc_ops.store(rhc, info, sample, instance)) return true;
  if (t_forwarding == nullptr || !IsShadow(cover.gv, info->guid)) return false;
  Refuse(cover.reader);
  return true;
}

void Free(ddsi_rhc* rhc) {
  Cover* cover = CoverOf(rhc);
  rhc->ops = reinterpret_cast<const ddsi_rhc_ops*>(cover->real);
  cover->real->rhc_ops.free(rhc);
  delete cover;
}

}  // namespace

void Refuse(const Guid& reader) { t_forwarding->refused_.push_back(reader); }

Forwarding::Forwarding() { t_forwarding = this; }
Forwarding::~Forwarding() { t_forwarding = nullptr; }

void CoverHistoryCache(ddsi_rhc* rhc, ddsi_domaingv* gv, const dds_qos_t& qos) {
  const bool is_reliable = qos.reliability.kind == DDS_RELIABILITY_RELIABLE;
  const bool has_history = qos.durability.kind >= DDS_DURABILITY_TRANSIENT_LOCAL;
  if (rhc == nullptr || (!is_reliable && !has_history)) return;
  auto* cover = new Cover;
  // dds_rhc is a ddsi_rhc with more operations.
  cover->real = reinterpret_cast<const dds_rhc_ops*>(rhc->ops);
  cover->operations = *cover->real;
  cover->operations.rhc_ops.store = Store;
  cover->operations.rhc_ops.free = Free;
  cover->gv = gv;
  cover->has_history = has_history;
  cover->waits_for_history = is_reliable && has_history;
  rhc->ops = &cover->operations.rhc_ops;
}

void NameCover(const ddsi_reader& reader) {
  if (Cover* cover = CoverOf(reader.rhc)) cover->reader = GuidOf(reader.e.guid);
}

MakingReader::MakingReader() { ++t_making_readers; }
MakingReader::~MakingReader() { --t_making_readers; }

bool StoreAddressed(const ddsi_reader& reader, const ddsi_writer& shadow, ddsi_serdata* sample) {
  ddsi_writer_info info;
  ddsi_make_writer_info(&info, &shadow.e, shadow.xqos, sample->statusinfo);
  ddsi_serdata* as_its_own = ddsi_serdata_ref_as_type(reader.type, sample);
  if (as_its_own == nullptr) return true;  // not of the reader's type
  ddsi_tkmap* map = shadow.e.gv->m_tkmap;
  ddsi_tkmap_instance* instance = ddsi_tkmap_lookup_instance_ref(map, as_its_own);
  bool stored = true;
  if (instance != nullptr) {
    Cover* cover = CoverOf(reader.rhc);
    stored = cover != nullptr ? cover->real->rhc_ops.store(reader.rhc, &info, as_its_own, instance)
                              : ddsi_rhc_store(reader.rhc, &info, as_its_own, instance);
    ddsi_tkmap_instance_unref(map, instance);
  }
  ddsi_serdata_unref(as_its_own);
  return stored;
}

void EndHistory(const ddsi_reader& reader, const ddsi_guid_t& shadow) {
  Cover* cover = CoverOf(reader.rhc);
  if (cover == nullptr) return;
  const std::lock_guard lock(cover->mutex);
  cover->caught_up[GuidOf(shadow)] = true;
}

}  // namespace tcs::dds
