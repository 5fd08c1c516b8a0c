#include "libtcs_preload/dds/silence.h"

namespace tcs::dds {

// After the real one, which has taken over what the user's configuration says: it may name
// interfaces, peers and iceoryx, none of which goes with "no transport".
int PrepareConfiguration(ddsi_domaingv* gv, cfgst* configuration) {
  const int result = Real().rtps_config_prep(gv, configuration);
  if (result < 0) return result;
  gv->config.transport_selector = DDSI_TRANS_NONE;
  gv->config.network_interfaces = nullptr;
  gv->config.peers = nullptr;
  gv->config.enable_shm = 0;
  return result;
}

}  // namespace tcs::dds
