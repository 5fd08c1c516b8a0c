// A domain without a network: no sockets, no threads that receive.
#pragma once

#include "libtcs_preload/dds/cyclone.h"

namespace tcs::dds {

// Hook.
int PrepareConfiguration(ddsi_domaingv* gv, cfgst* configuration);

}  // namespace tcs::dds
