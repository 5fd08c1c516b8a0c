#include "libtcs_preload/dds/muting.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "libtcs_preload/dds/deaf_mute.h"
#include "libtcs_preload/dds/held_messages.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/own_news.h"
#include "libtcs_preload/dds/program.h"

namespace tcs::dds {
namespace {

using HalfGuid = std::array<std::uint8_t, 12>;

// The part that the GUIDs of a participant and of all that it has begin with.
HalfGuid HalfGuidAt(const std::uint8_t* guid) {
  HalfGuid prefix;
  std::copy_n(guid, prefix.size(), prefix.begin());
  return prefix;
}

struct Mute {
  std::int64_t since_ns;
  HeldMessages held;
  std::set<HalfGuid> lost;  // participants whose leases are over
  std::int64_t last_lost_ns = INT64_MIN;
};

struct Mutes {
  std::mutex mutex;
  std::atomic<int> count{0};
  std::map<std::uint32_t, Mute> by_domain;
};

Mutes& TheMutes() {
  static auto* state = new Mutes;
  return *state;
}

Mute& Begin(Mutes& state, const ddsi_domaingv& gv) {
  const auto [place, is_new] = state.by_domain.try_emplace(gv.config.domainId);
  if (!is_new) return place->second;
  ++state.count;
  place->second.since_ns = TheLink().now();
  if (gv.config.initial_mute != 0) WakeAfter(gv, gv.config.initial_deaf_mute_reset);
  for (const OwnNews& news : NewsOf(gv)) {
    if (news.message.kind == shm::DdsKind::kParticipant) WakeAfter(gv, news.message.lease_ns);
  }
  return place->second;
}

// Other processes miss participants that they do not hear.
void EndLeases(Mute& mute, const std::vector<OwnNews>& all) {
  const std::int64_t now_ns = TheLink().now();
  for (const OwnNews& news : all) {
    const shm::DdsMessage& known = news.message;
    if (known.kind != shm::DdsKind::kParticipant) continue;
    if (known.lease_ns > now_ns - mute.since_ns) continue;
    if (!mute.lost.insert(HalfGuidAt(known.subject)).second) continue;
    mute.last_lost_ns = now_ns;
    shm::DdsMessage gone =
        MessageOf(shm::DdsKind::kParticipant, known.domain, GuidAt(known.subject));
    gone.flags = shm::kDdsGone;
    SendHeld(gone, {});
  }
}

// Others are told of all that they have lost, as it is now.
void LetGo(const Mute& mute, const std::vector<OwnNews>& all) {
  const auto is_lost = [&mute](const shm::DdsMessage& message) {
    return mute.lost.contains(HalfGuidAt(message.subject));
  };
  for (OwnNews news : all) {
    if (is_lost(news.message)) SendHeld(news.message, news.payload);
  }
  for (HeldMessage one : mute.held.all()) {
    if (one.message.to != shm::kDdsEverybody || !is_lost(one.message)) {
      SendHeld(one.message, one.payload);
    }
  }
}

}  // namespace

bool AnyIsMute() { return TheMutes().count.load(std::memory_order_relaxed) > 0; }

bool HoldsBack(const ddsi_domaingv& gv, const shm::DdsMessage& message, const void* payload,
               std::size_t size) {
  if (gv.mute == 0 && !AnyIsMute()) return false;
  Mutes& state = TheMutes();
  const std::lock_guard lock(state.mutex);
  // Messages from before may still be held.
  if (gv.mute == 0 && !state.by_domain.contains(gv.config.domainId)) return false;
  Begin(state, gv).held.Add(message, payload, size);
  return true;
}

void NoteMute(const ddsi_domaingv& gv) {
  if (gv.mute == 0) return;
  Mutes& state = TheMutes();
  const std::lock_guard lock(state.mutex);
  Begin(state, gv);
}

void LookAtMute(const ddsi_domaingv& gv) {
  NoteMute(gv);
  if (!AnyIsMute()) return;
  Mutes& state = TheMutes();
  const std::lock_guard lock(state.mutex);
  const auto found = state.by_domain.find(gv.config.domainId);
  if (found == state.by_domain.end()) return;
  const std::vector<OwnNews> all = NewsOf(gv);
  if (gv.mute != 0) return EndLeases(found->second, all);
  const std::int64_t since_lost_ns = TheLink().now() - found->second.last_lost_ns;
  if (!found->second.lost.empty() && since_lost_ns < kRediscovery) {
    return WakeAfter(gv, kRediscovery - since_lost_ns);
  }
  LetGo(found->second, all);
  state.by_domain.erase(found);
  --state.count;
}

void EndMute(std::uint32_t domain) {
  Mutes& state = TheMutes();
  const std::lock_guard lock(state.mutex);
  const auto found = state.by_domain.find(domain);
  if (found == state.by_domain.end()) return;
  for (HeldMessage one : found->second.held.all()) {
    if ((one.message.flags & shm::kDdsGone) != 0) SendHeld(one.message, {});
  }
  state.by_domain.erase(found);
  --state.count;
}

bool IsHeldFull(const ddsi_domaingv& gv, const Guid& writer) {
  Mutes& state = TheMutes();
  const std::lock_guard lock(state.mutex);
  const auto found = state.by_domain.find(gv.config.domainId);
  if (found == state.by_domain.end()) return false;
  return found->second.held.SizeOf(writer) > gv.config.whc_highwater_mark;
}

}  // namespace tcs::dds
