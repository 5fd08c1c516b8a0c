// Shadows look like their originals: a shadow has its original's GUID. ddsperf, for one, names
// partitions after participants' GUIDs, and the built-in topics show them.
//
// Cyclone makes a participant's GUID from a base and a counter, an endpoint's from a cursor.
#pragma once

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

// While this object lives, the participant that the calling thread makes gets this GUID.
class MakingShadow {
 public:
  explicit MakingShadow(const Guid& participant);
  ~MakingShadow();
  MakingShadow(const MakingShadow&) = delete;
  MakingShadow& operator=(const MakingShadow&) = delete;
};

// The next entity of a shadow participant gets the last four bytes of `entity` if it is of the same
// kind.
void SetNextEntity(ddsi_domaingv* gv, const Guid& participant, const Guid& entity);
// For topics, which have no counterpart elsewhere: the next entity gets bytes that no endpoint has.
void SetNextEntityOutOfTheWay(ddsi_domaingv* gv, const Guid& participant);

// Calls the real ddsi_new_participant.
dds_return_t MakeParticipant(ddsi_guid_t* guid, ddsi_domaingv* gv, unsigned flags,
                             const ddsi_plist_t* plist);

// Hooks.
std::uint64_t GenerateInstance();
bool MakeSeed(ddsrt_prng_seed* seed);

}  // namespace tcs::dds
