// The shim's side of what it does for libtcs_dds.so (link.h).
#pragma once

#include "libtcs_preload/dds/link.h"

namespace tcs::preload {

extern const dds::Link kDdsLink;

}  // namespace tcs::preload
