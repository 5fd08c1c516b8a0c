// How a transient-local reader of the program gets what writers elsewhere had before it.
//
// A shadow writer has a history of its own, which Cyclone would hand to the reader at once, but it
// is not the writer's. So the reader's history cache is covered: a transient-local shadow writer's
// samples are dropped until its process has sent the real history, addressed to this reader, and
// then kHistoryEnd.
#pragma once

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

// Covers a history cache, before its reader is made, if the reader's QoS ask for that.
void CoverHistoryCache(ddsi_rhc* rhc, ddsi_domaingv* gv, const dds_qos_t& qos);

// While it lives, the calling thread makes a reader: shadows' history does not count.
class MakingReader {
 public:
  MakingReader();
  ~MakingReader();
  MakingReader(const MakingReader&) = delete;
  MakingReader& operator=(const MakingReader&) = delete;
};

// For the deliverer, awake. A sample for this reader alone, past the cover.
void StoreAddressed(const ddsi_reader& reader, const ddsi_writer& shadow, ddsi_serdata* sample);
// From now on the reader gets what the shadow writes.
void EndHistory(const ddsi_reader& reader, const ddsi_guid_t& shadow);

}  // namespace tcs::dds
