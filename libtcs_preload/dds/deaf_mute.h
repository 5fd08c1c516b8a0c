// Domains that the program has made deaf or mute (dds_domain_set_deafmute), or their configuration
// (Internal/ControlTopic): as if the network lost all that comes, or goes.
//
// Cyclone's own flags say which domains are; the deliverer looks at them when it is woken.
#pragma once

#include "libtcs_preload/dds/cyclone.h"
#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

// A process that has lost sight of another, whose lease is over, finds it again that much later at
// the earliest: Cyclone needs some of that time to collect what it knew under the same GUID.
constexpr dds_duration_t kRediscovery = DDS_MSECS(100);

// Hook of ddsi_set_deafmute.
void SetDeafMute(ddsi_domaingv* gv, bool deaf, bool mute, std::int64_t reset_after);

// Hook: a program may have a deaf domain miss a participant before its lease is over.
int DeleteProxy(ddsi_domaingv* gv, const ddsi_guid_t* guid, ddsrt_wctime_t timestamp, int implicit);
// For the deliverer: whether that has happened since it was asked the last time.
bool IsToBeLost(std::uint32_t domain, const Guid& participant);

// Wakes the deliverer so much later, unless the domain is gone by then.
void WakeAfter(const ddsi_domaingv& gv, dds_duration_t delay);

}  // namespace tcs::dds
