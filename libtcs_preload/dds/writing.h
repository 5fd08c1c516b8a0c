// The calls that write (calls.h): such a call first waits for readers elsewhere that cannot keep
// up.
#pragma once

#include "libtcs_preload/dds/calls.h"

namespace tcs::dds {

// Null for a call of another kind.
void* WritingHook(Call call);

}  // namespace tcs::dds
