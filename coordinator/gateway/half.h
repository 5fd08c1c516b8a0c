// One of the gateway's two processes, as DDS sees it: a reader or a writer for each topic. The
// samples that its readers get go into the stream to the other process, and its writers write the
// samples that come from there.
//
// Samples are carried as CDR, with their timestamps; nothing here looks into them. The readers do
// not get what this process itself writes, so nothing goes round.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <map>
#include <vector>

#include "coordinator/gateway/frames.h"
#include "coordinator/gateway/served_end.h"

struct ddsi_sertype;

namespace tcs::gateway {

enum class Side {
  kSimulation,  // by endpoints: the simulation's other end
  kPrograms,    // by sockets: in the place of the simulation
};

class Half {
 public:
  // Exits with a sentence on stderr where DDS refuses something. A half, with all that it has,
  // outlives the process's threads: it lives until the process ends.
  Half(Side side, const std::vector<ServedEnd>& ends, Frames& frames);

  void Write(const Frame& frame);

  struct Node {
    std::string name_space;
    std::vector<dds_guid_t> readers, writers;
  };
  struct Participant {
    dds_entity_t entity = 0;
    std::vector<Node> nodes;
  };
  // By domain.
  const std::map<int, Participant>& participants() const { return participants_; }

 private:
  // The argument of a listener's calls.
  struct Heard {
    Half* half = nullptr;
    std::uint32_t end = 0;
  };
  struct Own {
    dds_entity_t endpoint = 0;
    const ddsi_sertype* type = nullptr;
  };

  bool Reads(const ServedEnd& end) const;
  Participant& ParticipantOf(int domain);
  void Add(const ServedEnd& end, Heard* heard);
  static void TakeAll(dds_entity_t reader, void* heard);

  Side side_;
  Frames& frames_;
  std::map<int, Participant> participants_;
  std::vector<Own> own_;
  std::vector<Heard> heard_;
};

// `result`, unless it is an error: then the process ends with a sentence.
dds_return_t OrEnd(dds_return_t result, const char* what);

}  // namespace tcs::gateway
