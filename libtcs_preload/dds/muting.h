// The messages that mute domains send (deaf_mute.h) are held back. When a domain is not mute any
// more, others get the held messages, but for those that nobody has promised them. Where the leases
// of the program's participants are over by then, others have lost them with all that they had, and
// find them anew.
//
// Thread-safe.
#pragma once

#include <cstddef>

#include "libtcs_preload/dds/guid.h"
#include "shm/dds_exchange.h"

namespace tcs::dds {

// False: the domain is not mute, and the message is to be sent.
bool HoldsBack(const ddsi_domaingv& gv, const shm::DdsMessage& message, const void* payload,
               std::size_t size);

// The program may have made the domain mute just now.
void NoteMute(const ddsi_domaingv& gv);

// For the deliverer, which visits the domain: ends leases, and sends what has been held of a domain
// that is not mute any more.
void LookAtMute(const ddsi_domaingv& gv);
// The domain has ended: others hear of its end at least.
void EndMute(std::uint32_t domain);

// Whether so much of the writer's data is held back as its history cache takes
// (Internal/Watermarks) before it makes the program wait.
bool IsHeldFull(const ddsi_domaingv& gv, const Guid& writer);
bool AnyIsMute();

}  // namespace tcs::dds
