#include "libtcs_preload/dds/ignore_local.h"

#include <chrono>
#include <utility>

namespace tcs::dds {
namespace {

// Listeners run while it is held, which may wait for a thread that wants it: not for ever.
constexpr std::chrono::milliseconds kLongestTurn{100};

struct Ignored {
  std::recursive_timed_mutex turn;
  std::mutex mutex;
  std::vector<std::pair<ddsi_domaingv*, Guid>> ignoring;  // the program's, with that policy
};

Ignored& TheIgnored() {
  static auto* state = new Ignored;
  return *state;
}

dds_ignorelocal_kind_t Policy(const dds_qos_t* qos) {
  dds_ignorelocal_kind_t kind = DDS_IGNORELOCAL_NONE;
  dds_qget_ignorelocal(qos, &kind);
  return kind;
}

// Of making an endpoint. Two that are made at a time may find each other twice: Cyclone then counts
// two that do not suit it where there is one.
std::unique_lock<std::recursive_timed_mutex> Turn() {
  std::unique_lock turn(TheIgnored().turn, std::defer_lock);
  static_cast<void>(turn.try_lock_for(kLongestTurn));
  return turn;
}

// Returns the policy that a reader or writer had; the same if it is gone.
dds_ignorelocal_kind_t ExchangePolicy(const ddsi_domaingv* gv, const Guid& guid,
                                      dds_ignorelocal_kind_t kind) {
  const auto exchange = [kind](auto& entity) {
    ddsrt_mutex_lock(&entity.e.qos_lock);
    const dds_ignorelocal_kind_t before = Policy(entity.xqos);
    dds_qset_ignorelocal(entity.xqos, kind);
    ddsrt_mutex_unlock(&entity.e.qos_lock);
    return before;
  };
  const ddsi_guid_t inner = InnerOf(guid);
  if (ddsi_writer* writer = entidx_lookup_writer_guid(gv->entity_index, &inner)) {
    return exchange(*writer);
  }
  if (ddsi_reader* reader = entidx_lookup_reader_guid(gv->entity_index, &inner)) {
    return exchange(*reader);
  }
  return kind;
}

void SetAll(ddsi_domaingv* gv, dds_ignorelocal_kind_t kind) {
  std::vector<Guid> guids;
  {
    Ignored& state = TheIgnored();
    const std::lock_guard lock(state.mutex);
    for (const auto& [domain, guid] : state.ignoring) {
      if (domain == gv) guids.push_back(guid);
    }
  }
  if (guids.empty()) return;
  const Awake awake(gv);
  for (const Guid& guid : guids) ExchangePolicy(gv, guid, kind);
}

}  // namespace

ShadowMatches::ShadowMatches(ddsi_domaingv* gv) : turn_(Turn()), gv_(gv) {
  SetAll(gv_, DDS_IGNORELOCAL_PARTICIPANT);
}
ShadowMatches::~ShadowMatches() { SetAll(gv_, DDS_IGNORELOCAL_PROCESS); }

OwnMatches::OwnMatches(ddsi_domaingv* gv, const dds_qos_t* qos, const std::vector<Guid>& others)
    : turn_(Turn()), gv_(gv), given_(qos) {
  if (Policy(qos) != DDS_IGNORELOCAL_PROCESS) return;
  milder_ = ddsi_xqos_dup(qos);
  dds_qset_ignorelocal(milder_, DDS_IGNORELOCAL_PARTICIPANT);
  const Awake awake(gv);
  for (const Guid& guid : others) {
    others_.emplace_back(guid, ExchangePolicy(gv, guid, DDS_IGNORELOCAL_PROCESS));
  }
}

OwnMatches::~OwnMatches() {
  if (milder_ == nullptr) return;
  dds_delete_qos(milder_);
  const Awake awake(gv_);
  for (const auto& [guid, policy] : others_) ExchangePolicy(gv_, guid, policy);
}

void OwnMatches::Made(const ddsi_guid_t& inner) {
  if (milder_ == nullptr) return;
  const Guid guid = GuidOf(inner);
  {
    const Awake awake(gv_);
    ExchangePolicy(gv_, guid, DDS_IGNORELOCAL_PROCESS);
  }
  Ignored& state = TheIgnored();
  const std::lock_guard lock(state.mutex);
  state.ignoring.emplace_back(gv_, guid);
}

void ForgetIgnoring(const Guid& guid) {
  Ignored& state = TheIgnored();
  const std::lock_guard lock(state.mutex);
  std::erase_if(state.ignoring, [&guid](const auto& entry) { return entry.second == guid; });
}

}  // namespace tcs::dds
