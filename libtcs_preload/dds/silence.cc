#include "libtcs_preload/dds/silence.h"

#include "libtcs_preload/dds/say.h"

namespace tcs::dds {

// After the real function, which has taken over what the user's configuration says: the
// configuration may name interfaces, peers and iceoryx, none of which goes with "no transport".
int PrepareConfiguration(ddsi_domaingv* gv, cfgst* configuration) {
  const int result = Real().rtps_config_prep(gv, configuration);
  if (result < 0) return result;
  gv->config.transport_selector = DDSI_TRANS_NONE;
  gv->config.network_interfaces = nullptr;
  gv->config.peers = nullptr;
  gv->config.enable_shm = 0;
  if (gv->config.xmit_lossiness != 0) {
    Say("Internal/Test/XmitLossiness of Cyclone's configuration does nothing, because samples do "
        "not "
        "go over a network: use dds_domain_set_deafmute, or loss in the scenario's network");
  }
  return result;
}

}  // namespace tcs::dds
