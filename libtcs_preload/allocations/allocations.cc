// Preloaded behind the shim under fixed accounting only: each allocation is charged a set cost.
//
// A planner computes for seconds without a call that the shim sees; without this library its time
// would stand still. Allocating is what all such programs do, in numbers that repeat from run to
// run. reallocarray, which calls realloc, needs no word. The allocation itself is left to the
// library that provides it: the C library, jemalloc, tcmalloc. free is that library's alone, so
// nothing may be handed out here that it does not know.
#include <malloc.h>
#include <stddef.h>
#include <stdlib.h>

#include "libtcs_preload/allocations/next.h"

// The shim's function. Absent where this library was preloaded without the shim.
extern "C" void tcs_charge_allocation() noexcept __attribute__((weak));

// The C library's own, for what dlsym may allocate while it looks for the next one.
extern "C" void* __libc_malloc(size_t size) noexcept;
extern "C" void* __libc_calloc(size_t count, size_t size) noexcept;
extern "C" void* __libc_realloc(void* block, size_t size) noexcept;

__thread bool tcs::charging::t_looking __attribute__((tls_model("initial-exec"))) = false;

namespace {

using tcs::charging::t_looking;

void Charge() {
  if (tcs_charge_allocation != nullptr && !t_looking) tcs_charge_allocation();
}

}  // namespace

TCS_EXPORT void* malloc(size_t size) noexcept {
  Charge();
  return TCS_NEXT(malloc, __libc_malloc)(size);
}

TCS_EXPORT void* calloc(size_t count, size_t size) noexcept {
  Charge();
  return TCS_NEXT(calloc, __libc_calloc)(count, size);
}

TCS_EXPORT void* realloc(void* block, size_t size) noexcept {
  Charge();
  return TCS_NEXT(realloc, __libc_realloc)(block, size);
}

TCS_EXPORT int posix_memalign(void** block, size_t alignment, size_t size) noexcept {
  Charge();
  return TCS_NEXT(posix_memalign, nullptr)(block, alignment, size);
}

TCS_EXPORT void* aligned_alloc(size_t alignment, size_t size) noexcept {
  Charge();
  return TCS_NEXT(aligned_alloc, nullptr)(alignment, size);
}

TCS_EXPORT void* memalign(size_t alignment, size_t size) noexcept {
  Charge();
  return TCS_NEXT(memalign, nullptr)(alignment, size);
}

TCS_EXPORT void* valloc(size_t size) noexcept {
  Charge();
  return TCS_NEXT(valloc, nullptr)(size);
}

TCS_EXPORT void* pvalloc(size_t size) noexcept {
  Charge();
  return TCS_NEXT(pvalloc, nullptr)(size);
}
