// The shim is told of each lock taken, too, in the same runs: a loop that looks whether others are
// done takes and releases a lock and does nothing else that could be counted (OMPL's
// AnytimePathShortening). Waiting for a lock that another thread has is the shim's business.
#include <pthread.h>

#include "libtcs_preload/allocations/next.h"

// The shim's function. Absent where this library was preloaded without the shim.
extern "C" void tcs_charge_lock() noexcept __attribute__((weak));

namespace {

void Charge() {
  if (tcs_charge_lock != nullptr) tcs_charge_lock();
}

}  // namespace

TCS_EXPORT int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  Charge();
  return TCS_NEXT(pthread_mutex_lock, nullptr)(mutex);
}

TCS_EXPORT int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  Charge();
  return TCS_NEXT(pthread_mutex_trylock, nullptr)(mutex);
}

TCS_EXPORT int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  Charge();
  return TCS_NEXT(pthread_rwlock_rdlock, nullptr)(lock);
}

TCS_EXPORT int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  Charge();
  return TCS_NEXT(pthread_rwlock_wrlock, nullptr)(lock);
}

TCS_EXPORT int pthread_rwlock_tryrdlock(pthread_rwlock_t* lock) noexcept {
  Charge();
  return TCS_NEXT(pthread_rwlock_tryrdlock, nullptr)(lock);
}

TCS_EXPORT int pthread_rwlock_trywrlock(pthread_rwlock_t* lock) noexcept {
  Charge();
  return TCS_NEXT(pthread_rwlock_trywrlock, nullptr)(lock);
}
