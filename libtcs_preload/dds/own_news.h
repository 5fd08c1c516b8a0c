// The news that the program has told others of its participants and endpoints, kept for the case
// that the program meets itself: that it has several domains of one name on the network
// (program.h).
//
// Such news goes through the coordinator, to this process as to others, in order with samples. But
// news that was told before the second domain was there is only here.
//
// Thread-safe.
#pragma once

#include <vector>

#include "libtcs_preload/dds/qos_code.h"
#include "shm/dds_exchange.h"

namespace tcs::dds {

struct OwnNews {
  shm::DdsMessage message;
  Payload payload;
};

// Called before the message is sent.
void NoteOwnNews(const shm::DdsMessage& message, const Payload& payload);
// Whether what has been noted goes through the coordinator to this process, too.
void NoteToldItself(const shm::DdsMessage& message, bool is_told);

// The announcements that are there, in the order in which they came, of domains in which the
// program meets itself, but for announcements that the program is told of through the coordinator:
// what such an announcement says is true when it comes, after what came before it.
std::vector<OwnNews> NewsForItself();

// All announcements that are there of what the program has in this domain.
std::vector<OwnNews> NewsOf(const ddsi_domaingv& gv);

}  // namespace tcs::dds
