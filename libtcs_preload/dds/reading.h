// Looking at what has come at virtual time v sees all that was sent before v: each reading call
// waits for that first.
#pragma once

#include "libtcs_preload/dds/calls.h"

namespace tcs::dds {

// The hook of a reading call.
void* ReadingHook(Call call);

}  // namespace tcs::dds
