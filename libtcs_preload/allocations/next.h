// The definition behind the one that this library puts before it.
#pragma once

#include <dlfcn.h>

namespace tcs::preload {

extern __thread bool t_looking __attribute__((tls_model("initial-exec")));

// True in what dlsym itself calls, which is not the program's doing.
inline bool IsLookingForNext() { return t_looking; }

template <class F>
F* Next(F*& cache, const char* name, F* meanwhile) {
  F* found = __atomic_load_n(&cache, __ATOMIC_RELAXED);
  if (__builtin_expect(found != nullptr, 1)) return found;
  if (t_looking) return meanwhile;
  t_looking = true;
  found = reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
  t_looking = false;
  __atomic_store_n(&cache, found, __ATOMIC_RELAXED);
  return found;
}

}  // namespace tcs::preload

// dlsym allocates by some functions; while it looks for one of those, `meanwhile` answers. It is
// null for the others.
#define TCS_NEXT(name, meanwhile)                                             \
  ([] {                                                                       \
    static __typeof__(&::name) cache;                                         \
    return ::tcs::preload::Next<__typeof__(::name)>(cache, #name, meanwhile); \
  }())

#define TCS_EXPORT extern "C" __attribute__((visibility("default")))
