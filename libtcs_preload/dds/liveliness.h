// Liveliness. A shadow with manual liveliness runs out by itself, by Cyclone's own lease, which
// each sample and each assertion of the original renews. A shadow with automatic liveliness never
// runs out in this process: the coordinator says when its original's process has been dead or
// stopped for long enough.
#pragma once

#include <vector>

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

// The readers see the shadow writer no longer alive, as if the lease of a writer in another process
// had run out.
void LoseLiveliness(ddsi_domaingv* gv, const ddsi_guid_t& shadow, const std::vector<Guid>& readers);

// The shadow's original has written again. The readers see the shadow alive, as if it were in
// another process.
void RegainLiveliness(ddsi_domaingv* gv, const ddsi_guid_t& shadow,
                      const std::vector<Guid>& readers);

// Hook.
dds_return_t AssertLiveliness(dds_entity_t entity);

}  // namespace tcs::dds
