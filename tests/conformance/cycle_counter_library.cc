// Reads the cycle counter, also before anybody has called it.
#include "tests/conformance/cycle_counter_library.h"

#include <x86intrin.h>

namespace {

std::uint64_t g_at_first;
__attribute__((constructor)) void Begin() { g_at_first = __rdtsc(); }

}  // namespace

extern "C" std::uint64_t ReadInLibrary() { return __rdtsc(); }
extern "C" std::uint64_t ReadAsItWasLoaded() { return g_at_first; }
