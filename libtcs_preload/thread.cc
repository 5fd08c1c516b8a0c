// New threads get slots of their own. Their waiting for each other ends in futex calls, which the
// kernel hands to the coordinator.
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/real.h"

using namespace tcs::preload;

namespace {

struct Start {
  void* (*routine)(void*);
  void* argument;
};

void EndOfThread(void*) {
  if (t_thread.slot == nullptr) return;
  Exchange(t_thread, Request{.kind = tcs::shm::NotificationKind::kThreadExit});
  t_thread.slot = nullptr;
  t_thread.attaching = true;  // what still runs of this thread is let through
}

void* RunThread(void* raw) {
  const Start start = *static_cast<Start*>(raw);
  free(raw);
  void* result = nullptr;
  pthread_cleanup_push(EndOfThread, nullptr);
  Current();
  result = start.routine(start.argument);
  pthread_cleanup_pop(1);
  return result;
}

// A thread must never get the host's real-time priority that it asks of its robot.
class InheritedScheduling {
 public:
  explicit InheritedScheduling(pthread_attr_t* attributes) : attributes_(attributes) {
    if (attributes_ == nullptr) return;
    pthread_attr_getinheritsched(attributes_, &saved_);
    pthread_attr_setinheritsched(attributes_, PTHREAD_INHERIT_SCHED);
  }
  ~InheritedScheduling() {
    if (attributes_ != nullptr) pthread_attr_setinheritsched(attributes_, saved_);
  }
  InheritedScheduling(const InheritedScheduling&) = delete;
  InheritedScheduling& operator=(const InheritedScheduling&) = delete;

 private:
  pthread_attr_t* attributes_;
  int saved_ = PTHREAD_INHERIT_SCHED;
};

}  // namespace

TCS_EXPORT int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*routine)(void*), void* argument) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr) return TCS_REAL(pthread_create)(thread, attributes, routine, argument);
  // The one allocation of the shim: pthread_create itself allocates, so this place may.
  auto* start = static_cast<Start*>(malloc(sizeof(Start)));
  if (start == nullptr) return EAGAIN;
  *start = Start{routine, argument};
  const InheritedScheduling inherited(const_cast<pthread_attr_t*>(attributes));
  const int error = TCS_REAL(pthread_create)(thread, attributes, RunThread, start);
  if (error != 0) {
    free(start);
    return error;
  }
  // From now on the coordinator knows of it, and does not let time pass it by.
  Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kSpawned});
  return 0;
}
