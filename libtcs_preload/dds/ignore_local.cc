#include "libtcs_preload/dds/ignore_local.h"

#include <chrono>
#include <utility>

namespace tcs::dds {
namespace {

// Listeners run while a turn is held, and may wait for a thread that wants the turn: not for ever.
constexpr std::chrono::milliseconds kLongestTurn{100};

// An endpoint of the program's that has another policy while a shadow is made.
struct Ignoring {
  ddsi_domaingv* gv;
  Guid guid;
  dds_ignorelocal_kind_t own, beside_shadow;
};

struct Ignored {
  std::recursive_timed_mutex turn;
  std::mutex mutex;
  std::vector<Ignoring> ignoring;
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

// The turn to make an endpoint. Two endpoints that are made at a time may find each other twice:
// Cyclone then counts two that do not suit an endpoint where there is one.
std::unique_lock<std::recursive_timed_mutex> Turn() {
  std::unique_lock turn(TheIgnored().turn, std::defer_lock);
  static_cast<void>(turn.try_lock_for(kLongestTurn));
  return turn;
}

// Returns the policy that a reader or writer had; `kind` if the entity is gone.
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

void SetAll(ddsi_domaingv* gv, dds_ignorelocal_kind_t Ignoring::*policy) {
  std::vector<Ignoring> all;
  {
    Ignored& state = TheIgnored();
    const std::lock_guard lock(state.mutex);
    for (const Ignoring& one : state.ignoring) {
      if (one.gv == gv) all.push_back(one);
    }
  }
  if (all.empty()) return;
  const Awake awake(gv);
  for (const Ignoring& one : all) ExchangePolicy(gv, one.guid, one.*policy);
}

}  // namespace

ShadowMatches::ShadowMatches(ddsi_domaingv* gv) : turn_(Turn()), gv_(gv) {
  SetAll(gv_, &Ignoring::beside_shadow);
}
ShadowMatches::~ShadowMatches() { SetAll(gv_, &Ignoring::own); }

OwnMatches::OwnMatches(ddsi_domaingv* gv, const dds_qos_t* qos, const std::vector<Guid>& others,
                       const std::vector<Guid>& shadows, bool no_shadows)
    : turn_(Turn()), gv_(gv), given_(qos), no_shadows_(no_shadows) {
  const bool no_others = Policy(qos) == DDS_IGNORELOCAL_PROCESS;
  if (no_others == no_shadows) return;  // the endpoint ignores all, as it is, or none
  if (no_others) {
    milder_ = ddsi_xqos_dup(qos);
    dds_qset_ignorelocal(milder_, DDS_IGNORELOCAL_PARTICIPANT);
  }
  const Awake awake(gv);
  for (const Guid& guid : no_others ? others : shadows) {
    ignoring_it_.emplace_back(guid, ExchangePolicy(gv, guid, DDS_IGNORELOCAL_PROCESS));
  }
}

OwnMatches::~OwnMatches() {
  if (milder_ != nullptr) dds_delete_qos(milder_);
  if (ignoring_it_.empty()) return;
  const Awake awake(gv_);
  for (const auto& [guid, policy] : ignoring_it_) ExchangePolicy(gv_, guid, policy);
}

void OwnMatches::Made(const ddsi_guid_t& inner) {
  Ignoring made{gv_, GuidOf(inner), Policy(given_), DDS_IGNORELOCAL_PARTICIPANT};
  if (milder_ != nullptr) {
    const Awake awake(gv_);
    ExchangePolicy(gv_, made.guid, made.own);
  } else if (no_shadows_) {
    made.beside_shadow = DDS_IGNORELOCAL_PROCESS;
  } else {
    return;
  }
  Ignored& state = TheIgnored();
  const std::lock_guard lock(state.mutex);
  state.ignoring.push_back(made);
}

void ForgetIgnoring(const Guid& guid) {
  Ignored& state = TheIgnored();
  const std::lock_guard lock(state.mutex);
  std::erase_if(state.ignoring, [&guid](const auto& entry) { return entry.guid == guid; });
}

}  // namespace tcs::dds
