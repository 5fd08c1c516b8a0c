// The covers of the program's readers' history caches, which samples of writers elsewhere go
// through.
//
// How a transient-local reader gets what writers elsewhere had before it: a shadow writer has a
// history of its own, which Cyclone would hand to the reader at once, but that history is not the
// writer's. So a transient-local shadow writer's samples are dropped until its process has sent the
// real history, addressed to this reader, and then kHistoryEnd.
//
// A cover also handles back-pressure of a reliable reader that has as many samples as its resource
// limits allow. Cyclone would have the deliverer wait for that reader with Cyclone's locks held,
// and the program could not even delete the reader. So the cover takes notice, and the deliverer
// tries again.
#pragma once

#include <vector>

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

// Covers a history cache, before its reader is made.
void CoverHistoryCache(ddsi_rhc* rhc, ddsi_domaingv* gv, const dds_qos_t& qos);

// While this object lives, the calling thread makes a reader: shadows' history does not count.
class MakingReader {
 public:
  MakingReader();
  ~MakingReader();
  MakingReader(const MakingReader&) = delete;
  MakingReader& operator=(const MakingReader&) = delete;
};

// Called once the reader is there.
void NameCover(const ddsi_reader& reader);

// While this object lives, the calling thread, the deliverer, writes a sample with a shadow writer.
class Forwarding {
 public:
  Forwarding();
  ~Forwarding();
  Forwarding(const Forwarding&) = delete;
  Forwarding& operator=(const Forwarding&) = delete;

  // The readers that have refused the sample for now.
  const std::vector<Guid>& refused() const { return refused_; }

 private:
  friend void Refuse(const Guid& reader);
  std::vector<Guid> refused_;
};

// For the deliverer, awake. A sample for this reader alone, past the cover. False: the reader is
// full.
bool StoreAddressed(const ddsi_reader& reader, const ddsi_writer& shadow, ddsi_serdata* sample);
// From now on the reader gets what the shadow writes.
void EndHistory(const ddsi_reader& reader, const ddsi_guid_t& shadow);

}  // namespace tcs::dds
