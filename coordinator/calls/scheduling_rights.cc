#include "coordinator/calls/scheduling_rights.h"

#include <linux/capability.h>
#include <sched.h>
#include <sys/resource.h>

#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

bool ignores_lack_of_real_time_limit = false;

bool IsPrivileged(const Credentials& credentials) { return credentials.Has(CAP_SYS_NICE); }

bool IsSameOwner(const Credentials& asking, pid_t tid) {
  const Credentials owner = ReadCredentials(tid);
  return asking.effective_uid == owner.effective_uid || asking.effective_uid == owner.real_uid;
}

// Where the kernel refuses to say the limit, as of a process that has changed users, /proc says it;
// a look there takes longer.
rlim_t LimitOf(pid_t tid, __rlimit_resource resource, const char* name) {
  rlimit limit{};
  return prlimit(tid, resource, nullptr, &limit) == 0 ? limit.rlim_cur : ReadSoftLimit(tid, name);
}

rlim_t RealTimeLimitOf(pid_t tid) {
  const rlim_t limit = LimitOf(tid, RLIMIT_RTPRIO, "Max realtime priority");
  return limit == 0 && ignores_lack_of_real_time_limit ? RLIM_INFINITY : limit;
}

}  // namespace

void IgnoreLackOfRealTimeLimit() { ignores_lack_of_real_time_limit = true; }

bool MaySetScheduling(pid_t asking, pid_t tid, const SchedulingParameters& now,
                      const SchedulingParameters& wanted) {
  const Credentials credentials = ReadCredentials(asking);
  if (IsPrivileged(credentials)) return true;
  if (wanted.policy == SCHED_DEADLINE) return false;
  if (IsRealTime(wanted.policy)) {
    const rlim_t most = RealTimeLimitOf(tid);
    if (wanted.policy != now.policy && most == 0) return false;
    const auto priority = static_cast<rlim_t>(wanted.priority);
    if (wanted.priority > now.priority && priority > most) return false;
  }
  // To leave SCHED_IDLE is to raise one's priority: to that of the nice value, which is 0 here.
  constexpr rlim_t kNiceLimitOfZero = 20;
  if (now.policy == SCHED_IDLE && wanted.policy != SCHED_IDLE &&
      LimitOf(tid, RLIMIT_NICE, "Max nice priority") < kNiceLimitOfZero) {
    return false;
  }
  if (now.resets_on_fork && !wanted.resets_on_fork) return false;
  return IsSameOwner(credentials, tid);
}

bool MaySetAffinity(pid_t asking, pid_t tid) {
  const Credentials credentials = ReadCredentials(asking);
  return IsPrivileged(credentials) || IsSameOwner(credentials, tid);
}

}  // namespace tcs
