// Tells the other processes what the program has.
//
// The caller is awake (cyclone.h), or holds the entity otherwise.
#pragma once

#include "libtcs_preload/dds/guid.h"
#include "shm/dds_exchange.h"

namespace tcs::dds {

void AnnounceParticipant(const ddsi_participant& participant);

// A writer that is new is made known (program.h) and told of; a writer that is known is left alone.
void AnnounceWriter(const ddsi_writer& writer);
// Topics, in a domain whose configuration asks for it (EnableTopicDiscoveryEndpoints).
bool MakesTopicsKnown(const ddsi_domaingv& gv);
void AnnounceTopic(const ddsi_topic& topic, const ddsi_sertype* type);
void AnnounceChange(const ddsi_topic& topic);
void AnnounceReader(const ddsi_reader& reader);

// Announces the same endpoint again with other QoS. Other QoS do not change which endpoints match:
// Cyclone refuses changes of policies that would.
void AnnounceChange(const ddsi_writer& writer);
void AnnounceChange(const ddsi_reader& reader);

void AnnounceGone(shm::DdsKind kind, const ddsi_domaingv& gv, const Guid& guid);

}  // namespace tcs::dds
