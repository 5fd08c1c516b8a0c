// The C library's own versions of functions that cannot be had from the kernel alone.
//
// Looked up on first use; only names that exist in glibc 2.36 already, since a failing dlsym
// allocates.
#pragma once

#include <dlfcn.h>

namespace tcs::preload {

#ifdef TCS_SIMULATED_HOST
void* SimulatedReal(const char* name);
#endif

template <class F>
F* LookUpReal(F*& cache, const char* name) {
  F* found = __atomic_load_n(&cache, __ATOMIC_RELAXED);
  if (found == nullptr) {
#ifdef TCS_SIMULATED_HOST
    found = reinterpret_cast<F*>(SimulatedReal(name));
#else
    found = reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
#endif
    __atomic_store_n(&cache, found, __ATOMIC_RELAXED);
  }
  return found;
}

// TCS_REAL(fork)() calls the C library's fork.
#define TCS_REAL(name)                                                   \
  ([] {                                                                  \
    static __typeof__(&::name) cache;                                    \
    return ::tcs::preload::LookUpReal<__typeof__(::name)>(cache, #name); \
  }())

}  // namespace tcs::preload
