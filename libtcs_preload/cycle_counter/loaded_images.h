// The program and the libraries that are loaded, as the loader tells debuggers of them (r_debug in
// <link.h>).
#pragma once

#include <link.h>

#include "shm/machine_code/image.h"

namespace tcs::preload {

// The loader's list; null: the program has none that can be found.
const r_debug* LoaderOfProgram();

// The image of an entry of the list. Without segments where they cannot be read. Neither the image
// nor its segments may be used once it can be unloaded.
shm::Image ImageOf(const r_debug& loader, const link_map& loaded);

// False for an image that is to be left alone: the loader, the kernel's library, tcs's own, and the
// C library, which draws from the counter how long it spins for an adaptive mutex, and nothing
// else.
bool IsOthersCode(const link_map& loaded);

}  // namespace tcs::preload
