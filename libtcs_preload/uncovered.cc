// Calls that read, wait for or are woken by time and that tcs does not make virtual yet. They go
// through to the C library as they are; the first use of each is reported to the coordinator, which
// names it to the user.
#include <dlfcn.h>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/real.h"

using namespace tcs::preload;

namespace {

using Untyped = long(long, long, long, long, long, long);

void ReportOnce(bool& reported, const char* name) {
  if (__atomic_exchange_n(&reported, true, __ATOMIC_RELAXED)) return;
  if (GuestThread* t = Current(); t != nullptr) {
    Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kUncovered, .text = name});
  }
}

}  // namespace

// All arguments of these functions travel in the six integer registers, whatever their types; so
// one shape fits all, under a C++ name of its own because the headers declare the real one.
#define TCS_UNCOVERED(name)                                                            \
  TCS_EXPORT long Uncovered_##name(long, long, long, long, long, long) __asm__(#name); \
  TCS_EXPORT long Uncovered_##name(long a, long b, long c, long d, long e, long f) {   \
    static bool reported;                                                              \
    static Untyped* real;                                                              \
    ReportOnce(reported, #name);                                                       \
    return LookUpReal<Untyped>(real, #name)(a, b, c, d, e, f);                         \
  }

TCS_UNCOVERED(aio_suspend)
TCS_UNCOVERED(aio_suspend64)
TCS_UNCOVERED(aio_read)
TCS_UNCOVERED(aio_read64)
TCS_UNCOVERED(aio_write)
TCS_UNCOVERED(aio_write64)
TCS_UNCOVERED(aio_fsync)
TCS_UNCOVERED(aio_fsync64)
TCS_UNCOVERED(lio_listio)
TCS_UNCOVERED(lio_listio64)
TCS_UNCOVERED(getaddrinfo_a)
TCS_UNCOVERED(gai_suspend)
