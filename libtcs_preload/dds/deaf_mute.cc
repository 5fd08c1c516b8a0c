#include "libtcs_preload/dds/deaf_mute.h"

#include <dds/ddsi/q_rtps.h>
#include <dds/ddsi/q_xevent.h>

#include <mutex>
#include <set>
#include <utility>

#include "libtcs_preload/dds/deliverer.h"
#include "libtcs_preload/dds/muting.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/program.h"

namespace tcs::dds {
namespace {

// In the domain's thread of timed events; at its end with "never".
void Wake(xevent* event, void*, ddsrt_mtime_t now) {
  if (now.v != DDS_NEVER) SendNudge();
  delete_xevent(event);
}

struct ToBeLost {
  std::mutex mutex;
  std::set<std::pair<std::uint32_t, Guid>> participants;
};

ToBeLost& TheToBeLost() {
  static auto* state = new ToBeLost;
  return *state;
}

}  // namespace

int DeleteProxy(ddsi_domaingv* gv, const ddsi_guid_t* guid, ddsrt_wctime_t timestamp,
                int implicit) {
  if (!IsShadow(gv, *guid)) {
    return Real().ddsi_delete_proxy_participant_by_guid(gv, guid, timestamp, implicit);
  }
  ToBeLost& state = TheToBeLost();
  {
    const std::lock_guard lock(state.mutex);
    state.participants.insert({gv->config.domainId, GuidOf(*guid)});
  }
  LookAgain();
  return DDS_RETCODE_OK;
}

bool IsToBeLost(std::uint32_t domain, const Guid& participant) {
  ToBeLost& state = TheToBeLost();
  const std::lock_guard lock(state.mutex);
  return state.participants.erase({domain, participant}) != 0;
}

void WakeAfter(const ddsi_domaingv& gv, dds_duration_t delay) {
  if (delay == DDS_INFINITY) return;
  qxev_callback(gv.xevents, ddsrt_mtime_add_duration(ddsrt_time_monotonic(), delay), Wake, nullptr);
}

void SetDeafMute(ddsi_domaingv* gv, bool deaf, bool mute, std::int64_t reset_after) {
  Real().ddsi_set_deafmute(gv, deaf, mute, reset_after);
  NoteMute(*gv);
  // After Cyclone's own event, which resets the flags.
  if (reset_after < DDS_INFINITY) WakeAfter(*gv, reset_after + 1000);
  LookAgain();
}

}  // namespace tcs::dds
