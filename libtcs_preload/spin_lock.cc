// A spin lock whose holder does not run is had sooner by letting it run.
#include <errno.h>
#include <pthread.h>
#include <sched.h>

#include "libtcs_preload/guest.h"
#include "libtcs_preload/real.h"

using namespace tcs::preload;

TCS_EXPORT int pthread_spin_lock(pthread_spinlock_t* lock) noexcept {
  if (Current() == nullptr) return TCS_REAL(pthread_spin_lock)(lock);
  for (;;) {
    const int error = pthread_spin_trylock(lock);
    if (error != EBUSY) return error;
    sched_yield();
  }
}
