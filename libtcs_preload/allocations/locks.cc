// Each lock that is asked for is charged a set cost, too, a hundredth of an allocation's: a thread
// that looks again and again, under a lock, at what others do neither allocates nor enters the
// kernel, and would stop the time that it waits for. Whether it gets the lock does not matter.
// pthread_spin_lock needs no word: the shim's calls pthread_spin_trylock.
#include <pthread.h>
#include <threads.h>

#include "libtcs_preload/allocations/next.h"

using namespace tcs::preload;

// The shim's. Absent where this library was preloaded without it.
extern "C" void tcs_charge_lock() noexcept __attribute__((weak));

// The C library's own, for an allocator that locks while dlsym allocates.
extern "C" int __pthread_mutex_lock(pthread_mutex_t* lock) noexcept;
extern "C" int __pthread_mutex_trylock(pthread_mutex_t* lock) noexcept;
extern "C" int __pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept;
extern "C" int __pthread_rwlock_tryrdlock(pthread_rwlock_t* lock) noexcept;
extern "C" int __pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept;
extern "C" int __pthread_rwlock_trywrlock(pthread_rwlock_t* lock) noexcept;

namespace {

void Charge() {
  if (tcs_charge_lock != nullptr && !IsLookingForNext()) tcs_charge_lock();
}

}  // namespace

#define TCS_CHARGED_LOCK(name, type, meanwhile) \
  TCS_EXPORT int name(type* lock) noexcept {    \
    Charge();                                   \
    return TCS_NEXT(name, meanwhile)(lock);     \
  }

TCS_CHARGED_LOCK(pthread_mutex_lock, pthread_mutex_t, __pthread_mutex_lock)
TCS_CHARGED_LOCK(pthread_mutex_trylock, pthread_mutex_t, __pthread_mutex_trylock)
TCS_CHARGED_LOCK(pthread_rwlock_rdlock, pthread_rwlock_t, __pthread_rwlock_rdlock)
TCS_CHARGED_LOCK(pthread_rwlock_tryrdlock, pthread_rwlock_t, __pthread_rwlock_tryrdlock)
TCS_CHARGED_LOCK(pthread_rwlock_wrlock, pthread_rwlock_t, __pthread_rwlock_wrlock)
TCS_CHARGED_LOCK(pthread_rwlock_trywrlock, pthread_rwlock_t, __pthread_rwlock_trywrlock)
TCS_CHARGED_LOCK(pthread_spin_trylock, volatile int, nullptr)
TCS_CHARGED_LOCK(mtx_lock, mtx_t, nullptr)
TCS_CHARGED_LOCK(mtx_trylock, mtx_t, nullptr)
