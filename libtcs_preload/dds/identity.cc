#include "libtcs_preload/dds/identity.h"

#include <atomic>
#include <mutex>

#include "libtcs_preload/dds/outgoing.h"

namespace tcs::dds {
namespace {

constexpr std::uint32_t kTopicsFrom = 0x600000;

thread_local const Guid* t_shadow;
thread_local bool t_next_is_zero;

std::mutex& BaseMutex() {
  static auto* mutex = new std::mutex;
  return *mutex;
}

void SetCursor(ddsi_domaingv* gv, const Guid& participant, std::uint32_t id) {
  const Awake awake(gv);
  const ddsi_guid_t guid = InnerOf(participant);
  ddsi_participant* pp = entidx_lookup_participant_guid(gv->entity_index, &guid);
  if (pp == nullptr) return;
  ddsrt_mutex_lock(&pp->e.lock);
  pp->avail_entityids.x.cursor = id;
  ddsrt_mutex_unlock(&pp->e.lock);
}

}  // namespace

MakingShadow::MakingShadow(const Guid& participant) { t_shadow = &participant; }
MakingShadow::~MakingShadow() { t_shadow = nullptr; }

void SetNextEntity(ddsi_domaingv* gv, const Guid& participant, const Guid& entity) {
  SetCursor(gv, participant, InnerOf(entity).entityid.u >> 8);
}

void SetNextEntityOutOfTheWay(ddsi_domaingv* gv, const Guid& participant) {
  SetCursor(gv, participant, kTopicsFrom);
}

dds_return_t MakeParticipant(ddsi_guid_t* guid, ddsi_domaingv* gv, unsigned flags,
                             const ddsi_plist_t* plist) {
  const std::lock_guard lock(BaseMutex());
  if (t_shadow == nullptr) return Real().ddsi_new_participant(guid, gv, flags, plist);
  // The GUID is the base's prefix, to which the next instance number is added.
  const ddsi_guid_prefix_t own = gv->ppguid_base.prefix;
  gv->ppguid_base.prefix = InnerOf(*t_shadow).prefix;
  t_next_is_zero = true;
  const dds_return_t result = Real().ddsi_new_participant(guid, gv, flags, plist);
  t_next_is_zero = false;
  gv->ppguid_base.prefix = own;
  return result;
}

std::uint64_t GenerateInstance() {
  if (t_next_is_zero) {
    t_next_is_zero = false;
    return 0;
  }
  return Real().ddsi_iid_gen();
}

// Each process has its own seeds, and the same ones in each run: instances then come in the same
// order. The seed is another one each time that the program begins anew with its first domain:
// GUIDs must not come back while others may still know them.
bool MakeSeed(ddsrt_prng_seed* seed) {
  static std::atomic<std::uint32_t> made;
  std::uint32_t value = OwnProcess() << 16 ^ made++;
  for (std::uint32_t& key : seed->key) key = value = value * 1664525u + 1013904223u;
  return true;
}

}  // namespace tcs::dds
