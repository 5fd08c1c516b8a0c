// What this process sends. Any thread; nothing but a lock of its own is taken, so that it may be
// called from inside Cyclone, whatever that has locked.
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

// Of a domain, whose name the message has. It is held back where the domain is mute (muting.h).
void Send(const ddsi_domaingv& gv, shm::DdsMessage& message, const Payload& payload);

// A sample's bytes as Cyclone has serialised them. One that is too large is counted and named.
void SendSample(const ddsi_domaingv& gv, shm::DdsMessage& message, const ddsi_serdata& sample,
                std::string_view topic);

// What has been held back.
void SendHeld(shm::DdsMessage& message, const Payload& payload);

// Has the deliverer look at what other threads of this process have left for it (deliverer.h).
void SendNudge();

}  // namespace tcs::dds
