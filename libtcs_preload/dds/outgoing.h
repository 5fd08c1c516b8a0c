// The messages that this process sends. For any thread. The functions take nothing but a lock of
// their own, so that they may be called from inside Cyclone, whatever Cyclone has locked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "libtcs_preload/dds/guid.h"
#include "libtcs_preload/dds/link.h"
#include "libtcs_preload/dds/qos_code.h"
#include "shm/dds_exchange.h"

namespace tcs::dds {

// Joins; false: not under tcs. Everything else here only after that.
bool Join(const Link& link);
const Link& TheLink();
std::uint32_t OwnProcess();

shm::DdsMessage MessageOf(shm::DdsKind kind, std::uint32_t domain, const Guid& subject);

// Sends a message of a domain, whose name the message has. The message is held back where the
// domain is mute (muting.h).
void Send(const ddsi_domaingv& gv, shm::DdsMessage& message, const Payload& payload);

// Sends a sample's bytes as Cyclone has serialised them. A sample that is too large is counted and
// named.
void SendSample(const ddsi_domaingv& gv, shm::DdsMessage& message, const ddsi_serdata& sample,
                std::string_view topic);

// Sends a message that has been held back.
void SendHeld(shm::DdsMessage& message, const Payload& payload);

// Has the deliverer look at what other threads of this process have left for it (deliverer.h).
void SendNudge();

}  // namespace tcs::dds
