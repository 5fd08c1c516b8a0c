// Calls for which the C library makes threads of its own, from inside. Those never register; the
// coordinator is told that they are there, so that it does not jump over the time they need.
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/real.h"

using namespace tcs::preload;

namespace {

using Untyped = long(long, long, long, long, long, long);

void TellOfThreads() {
  if (const Entered t; t != nullptr) {
    Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kStrangers});
  }
}

}  // namespace

// All arguments of these functions travel in the six integer registers, whatever their types; so
// one shape fits all, under a C++ name of its own because the headers declare the real one.
#define TCS_MAKES_THREADS(name)                                                           \
  TCS_EXPORT long MakesThreads_##name(long, long, long, long, long, long) __asm__(#name); \
  TCS_EXPORT long MakesThreads_##name(long a, long b, long c, long d, long e, long f) {   \
    static Untyped* real;                                                                 \
    TellOfThreads();                                                                      \
    return LookUpReal<Untyped>(real, #name)(a, b, c, d, e, f);                            \
  }

TCS_MAKES_THREADS(aio_read)
TCS_MAKES_THREADS(aio_read64)
TCS_MAKES_THREADS(aio_write)
TCS_MAKES_THREADS(aio_write64)
TCS_MAKES_THREADS(aio_fsync)
TCS_MAKES_THREADS(aio_fsync64)
TCS_MAKES_THREADS(lio_listio)
TCS_MAKES_THREADS(lio_listio64)
TCS_MAKES_THREADS(getaddrinfo_a)
