// Partitioning/IgnoredPartitions of Cyclone's configuration: endpoints that have nothing to do with
// the network. Such endpoints match others of their own process and domain only, whatever else
// their QoS say.
#pragma once

#include "libtcs_preload/dds/cyclone.h"

namespace tcs::dds {

// Whether an endpoint of the program's with this QoS will be such an endpoint: any of its
// partitions is ignored for its topic.
bool IsIgnored(const ddsi_config& config, const char* topic, const dds_qos_t& qos);

}  // namespace tcs::dds
