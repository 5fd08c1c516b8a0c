// New threads get slots of their own. The waits of threads for each other end in futex calls, which
// the kernel hands to the coordinator.
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include <cstdint>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/pthread_id.h"
#include "libtcs_preload/real.h"
#include "libtcs_preload/spawn.h"

using namespace tcs::preload;

namespace {

struct Start {
  void* (*routine)(void*);
  void* argument;
};

void* RunThread(void* raw) {
  const Start start = *static_cast<Start*>(raw);
  Current();
  free(raw);  // which may wait for another thread, so only now
  return start.routine(start.argument);
}

// The requests of the attributes to the scheduler are meant for the robot's. The host's must not
// hear of them: the requests are taken out of the attributes while the thread is made.
class SchedulingAsked {
 public:
  explicit SchedulingAsked(pthread_attr_t* attributes) : attributes_(attributes) {
    if (attributes_ == nullptr) return;
    pthread_attr_getinheritsched(attributes_, &inherit_);
    if (inherit_ == PTHREAD_EXPLICIT_SCHED) {
      sched_param param{};
      pthread_attr_getschedpolicy(attributes_, &policy_);
      pthread_attr_getschedparam(attributes_, &param);
      priority_ = param.sched_priority;
    }
    pthread_attr_setinheritsched(attributes_, PTHREAD_INHERIT_SCHED);
    cpu_set_t every;
    memset(&every, 0xff, sizeof every);
    // Attributes without a set of their own say that all cores are allowed.
    if (pthread_attr_getaffinity_np(attributes_, sizeof cores_, &cores_) == 0 &&
        memcmp(&cores_, &every, sizeof every) != 0) {
      has_cores_ = true;
      pthread_attr_setaffinity_np(attributes_, 0, &cores_);  // of size 0: none
    }
  }
  ~SchedulingAsked() {
    if (attributes_ == nullptr) return;
    pthread_attr_setinheritsched(attributes_, inherit_);
    if (has_cores_) pthread_attr_setaffinity_np(attributes_, sizeof cores_, &cores_);
  }
  SchedulingAsked(const SchedulingAsked&) = delete;
  SchedulingAsked& operator=(const SchedulingAsked&) = delete;

  bool is_explicit() const { return policy_ >= 0; }

  // Whether the caller may have such a thread.
  Request Question() const {
    return Request{.kind = tcs::shm::NotificationKind::kPriority,
                   .args = {0, policy_, priority_, 1}};
  }

  Request AnnouncementOf(pthread_t thread) const {
    const auto cores = static_cast<std::int64_t>(CoresIn(sizeof cores_, &cores_));
    return Request{
        .kind = tcs::shm::NotificationKind::kMadeThread,
        .args = {static_cast<std::int64_t>(thread), policy_, priority_, has_cores_ ? cores : 0}};
  }

 private:
  pthread_attr_t* attributes_;
  int inherit_ = PTHREAD_INHERIT_SCHED;
  int policy_ = -1;
  int priority_ = 0;
  bool has_cores_ = false;
  cpu_set_t cores_;
};

}  // namespace

TCS_EXPORT int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*routine)(void*), void* argument) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(pthread_create)(thread, attributes, routine, argument);
  // The one allocation of the shim: pthread_create itself allocates, so this place may.
  auto* start = static_cast<Start*>(malloc(sizeof(Start)));
  if (start == nullptr) return EAGAIN;
  *start = Start{routine, argument};
  const SchedulingAsked asked(const_cast<pthread_attr_t*>(attributes));
  if (asked.is_explicit()) {
    const auto refused = static_cast<int>(-Exchange(*t, asked.Question()).values[0]);
    if (refused != 0) {
      free(start);
      return refused;
    }
  }
  const Announcement announcement(t);
  const int error = TCS_REAL(pthread_create)(thread, attributes, RunThread, start);
  if (error != 0) {
    free(start);
    return error;
  }
  // From now on the coordinator knows of the new thread, and does not let time pass it by.
  Exchange(*t, asked.AnnouncementOf(*thread));
  return 0;
}
