// The definition behind a function of this library: the C library's, jemalloc's, tcmalloc's.
#pragma once

#include <dlfcn.h>

namespace tcs::charging {

// The thread is in dlsym, and what it allocates there is not the program's.
extern __thread bool t_looking __attribute__((tls_model("initial-exec")));

template <class F>
F* Next(F*& cache, const char* name, F* meanwhile) {
  F* found = __atomic_load_n(&cache, __ATOMIC_RELAXED);
  if (found != nullptr) return found;
  if (t_looking) return meanwhile;
  t_looking = true;
  found = reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
  t_looking = false;
  __atomic_store_n(&cache, found, __ATOMIC_RELAXED);
  return found;
}

}  // namespace tcs::charging

// dlsym never calls `name` itself where there is no `meanwhile`.
#define TCS_NEXT(name, meanwhile)                                            \
  ([] {                                                                      \
    static __typeof__(&::name) cache;                                        \
    return tcs::charging::Next<__typeof__(::name)>(cache, #name, meanwhile); \
  }())

#define TCS_EXPORT extern "C" __attribute__((visibility("default")))
