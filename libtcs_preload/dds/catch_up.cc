#include "libtcs_preload/dds/catch_up.h"

#include <mutex>
#include <unordered_map>

#include "libtcs_preload/dds/program.h"

namespace tcs::dds {
namespace {

thread_local int t_making_readers;

// Found from a covered cache by its operations, which are its own copy.
struct Cover {
  dds_rhc_ops operations;  // first
  const dds_rhc_ops* real;
  ddsi_domaingv* gv;
  bool waits_for_history;
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
  if (t_making_readers == 0 && !cover.waits_for_history) return false;
  if (!IsShadow(writer)) return false;
  if (!cover.waits_for_history) return true;
  const std::lock_guard lock(cover.mutex);
  const auto [place, is_new] = cover.caught_up.try_emplace(Guid::Of(writer));
  if (is_new) place->second = !HasHistory(*cover.gv, writer);
  return !place->second;
}

bool Store(ddsi_rhc* rhc, const ddsi_writer_info* info, ddsi_serdata* sample,
           ddsi_tkmap_instance* instance) {
  Cover& cover = *CoverOf(rhc);
  if (IsDropped(cover, info->guid)) return true;
  return cover.real->rhc_ops.store(rhc, info, sample, instance);
}

void Free(ddsi_rhc* rhc) {
  Cover* cover = CoverOf(rhc);
  rhc->ops = reinterpret_cast<const ddsi_rhc_ops*>(cover->real);
  cover->real->rhc_ops.free(rhc);
  delete cover;
}

}  // namespace

void CoverHistoryCache(ddsi_rhc* rhc, ddsi_domaingv* gv, const dds_qos_t& qos) {
  if (rhc == nullptr || qos.durability.kind < DDS_DURABILITY_TRANSIENT_LOCAL) return;
  auto* cover = new Cover;
  // dds_rhc is a ddsi_rhc with more operations.
  cover->real = reinterpret_cast<const dds_rhc_ops*>(rhc->ops);
  cover->operations = *cover->real;
  cover->operations.rhc_ops.store = Store;
  cover->operations.rhc_ops.free = Free;
  cover->gv = gv;
  cover->waits_for_history = qos.reliability.kind == DDS_RELIABILITY_RELIABLE;
  rhc->ops = &cover->operations.rhc_ops;
}

MakingReader::MakingReader() { ++t_making_readers; }
MakingReader::~MakingReader() { --t_making_readers; }

void StoreAddressed(const ddsi_reader& reader, const ddsi_writer& shadow, ddsi_serdata* sample) {
  ddsi_writer_info info;
  ddsi_make_writer_info(&info, &shadow.e, shadow.xqos, sample->statusinfo);
  ddsi_tkmap* map = shadow.e.gv->m_tkmap;
  ddsi_tkmap_instance* instance = ddsi_tkmap_lookup_instance_ref(map, sample);
  if (instance == nullptr) return;
  Cover* cover = CoverOf(reader.rhc);
  if (cover != nullptr) {
    cover->real->rhc_ops.store(reader.rhc, &info, sample, instance);
  } else {
    ddsi_rhc_store(reader.rhc, &info, sample, instance);
  }
  ddsi_tkmap_instance_unref(map, instance);
}

void EndHistory(const ddsi_reader& reader, const ddsi_guid_t& shadow) {
  Cover* cover = CoverOf(reader.rhc);
  if (cover == nullptr) return;
  const std::lock_guard lock(cover->mutex);
  cover->caught_up[Guid::Of(shadow)] = true;
}

}  // namespace tcs::dds
