// The options that AddressSanitizer's runtime asks the program for as it starts. Without them the
// runtime would refuse to run where the shim was loaded before it, as into every program that is
// linked to the runtime.
#include "libtcs_preload/guest.h"

// The runtime's own calls and checks do not depend on the order: the runtime looks up the functions
// that it stands before by dlsym(RTLD_NEXT), as the shim does, so that each call passes both.
TCS_EXPORT const char* __asan_default_options() noexcept { return "verify_asan_link_order=0"; }
