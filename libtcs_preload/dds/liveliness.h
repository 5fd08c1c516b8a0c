// Liveliness. A shadow with manual liveliness runs out by itself, by Cyclone's own lease, which
// each sample and each assertion of the original renews. One with automatic liveliness never does
// in this process: the coordinator says when its process has been
// dead or stopped for long enough.
#pragma once

#include <vector>

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

// The readers see the shadow writer no longer alive, as if the lease of a writer in another process
// had run out.
void LoseLiveliness(ddsi_domaingv* gv, const ddsi_guid_t& shadow, const std::vector<Guid>& readers);

// It has written again. Its readers see it alive, as if it were in another process.
void RegainLiveliness(ddsi_domaingv* gv, const ddsi_guid_t& shadow,
                      const std::vector<Guid>& readers);

// Hook.
dds_return_t AssertLiveliness(dds_entity_t entity);

}  // namespace tcs::dds
