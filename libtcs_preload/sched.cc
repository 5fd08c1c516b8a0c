// Policies, priorities and affinities act on the robot's virtual scheduler, never on the host's.
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/pthread_id.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"
#include "libtcs_preload/spinning/pauses.h"
#include "libtcs_preload/user_memory.h"

using namespace tcs::preload;
using tcs::shm::kKeepPolicy;
using tcs::shm::NotificationKind;

namespace {

constexpr std::size_t kMostOfSet = sizeof(unsigned long);  // robots have no more cores

struct Scheduling {
  int policy;  // with SCHED_RESET_ON_FORK
  int priority;
};

timespec IntervalOf(int policy) {
  constexpr timespec kRoundRobinQuantum{0, 100'000'000};  // the virtual scheduler's, and Linux's
  return (policy & ~SCHED_RESET_ON_FORK) == SCHED_RR ? kRoundRobinQuantum : timespec{};
}

// 0, or an error number.
int Set(GuestThread& t, pid_t tid, int policy, int priority) {
  const Reply reply =
      Exchange(t, Request{.kind = NotificationKind::kPriority, .args = {tid, policy, priority}});
  return static_cast<int>(-reply.values[0]);
}

int Get(GuestThread& t, pid_t tid, Scheduling* scheduling) {
  const Reply reply = Exchange(t, Request{.kind = NotificationKind::kPriorityGet, .args = {tid}});
  if (reply.values[0] < 0) return static_cast<int>(-reply.values[0]);
  *scheduling = {static_cast<int>(reply.values[0]), static_cast<int>(reply.values[1])};
  return 0;
}

// Sets the robot's cores that the thread may use, unless 0, and asks for them.
int Affinity(GuestThread& t, pid_t tid, unsigned long wanted, unsigned long* cores) {
  const Reply reply = Exchange(t, Request{.kind = NotificationKind::kAffinity,
                                          .args = {tid, static_cast<std::int64_t>(wanted)}});
  *cores = static_cast<unsigned long>(reply.values[1]);
  return static_cast<int>(-reply.values[0]);
}

int SetAffinity(GuestThread& t, pid_t tid, std::size_t size, const cpu_set_t* set) {
  if (!CanRead(set, size < kMostOfSet ? size : kMostOfSet)) return EFAULT;
  unsigned long cores = CoresIn(size, set);
  return cores == 0 ? EINVAL : Affinity(t, tid, cores, &cores);
}

int GetAffinity(GuestThread& t, pid_t tid, std::size_t size, cpu_set_t* set) {
  if (size < sizeof(unsigned long) || size % sizeof(unsigned long) != 0) return EINVAL;
  unsigned long cores = 0;
  if (const int error = Affinity(t, tid, 0, &cores); error != 0) return error;
  if (!CanOverwrite(set, size)) return EFAULT;
  memset(set, 0, size);
  memcpy(set, &cores, sizeof cores);
  return 0;
}

int AsErrno(int error) { return error == 0 ? 0 : Fail(error); }

}  // namespace

TCS_EXPORT int sched_setscheduler(pid_t pid, int policy, const sched_param* param) noexcept {
  const Entered t;
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_setscheduler, pid, policy, Arg(param))));
  if (pid < 0 || param == nullptr) return Fail(EINVAL);
  sched_param wanted;
  if (!CopyIn(&wanted, param)) return Fail(EFAULT);
  if (policy < 0) return Fail(EINVAL);
  return AsErrno(Set(*t, pid, policy, wanted.sched_priority));
}

TCS_EXPORT int sched_getscheduler(pid_t pid) noexcept {
  const Entered t;
  if (t == nullptr) return static_cast<int>(ToErrno(RawSyscall(SYS_sched_getscheduler, pid)));
  if (pid < 0) return Fail(EINVAL);
  Scheduling found{};
  const int error = Get(*t, pid, &found);
  return error == 0 ? found.policy : Fail(error);
}

TCS_EXPORT int sched_setparam(pid_t pid, const sched_param* param) noexcept {
  const Entered t;
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_setparam, pid, Arg(param))));
  if (pid < 0 || param == nullptr) return Fail(EINVAL);
  sched_param wanted;
  if (!CopyIn(&wanted, param)) return Fail(EFAULT);
  return AsErrno(Set(*t, pid, kKeepPolicy, wanted.sched_priority));
}

TCS_EXPORT int sched_getparam(pid_t pid, sched_param* param) noexcept {
  const Entered t;
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_getparam, pid, Arg(param))));
  if (pid < 0 || param == nullptr) return Fail(EINVAL);
  Scheduling found{};
  const int error = Get(*t, pid, &found);
  if (error != 0) return Fail(error);
  return CopyOut(param, sched_param{found.priority}) ? 0 : Fail(EFAULT);
}

TCS_EXPORT int sched_rr_get_interval(pid_t pid, timespec* interval) noexcept {
  const Entered t;
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_rr_get_interval, pid, Arg(interval))));
  if (pid < 0) return Fail(EINVAL);
  Scheduling found{};
  const int error = Get(*t, pid, &found);
  if (error != 0) return Fail(error);
  return CopyOut(interval, IntervalOf(found.policy)) ? 0 : Fail(EFAULT);
}

TCS_EXPORT int pthread_setschedparam(pthread_t thread, int policy,
                                     const sched_param* param) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(pthread_setschedparam)(thread, policy, param);
  const pid_t tid = TidOf(thread);
  if (tid < 0) return ESRCH;
  return policy < 0 ? EINVAL : Set(*t, tid, policy, param->sched_priority);
}

TCS_EXPORT int pthread_getschedparam(pthread_t thread, int* policy, sched_param* param) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(pthread_getschedparam)(thread, policy, param);
  Scheduling found{};
  const pid_t tid = TidOf(thread);
  const int error = tid < 0 ? ESRCH : Get(*t, tid, &found);
  if (error != 0) return error;
  *policy = found.policy;
  param->sched_priority = found.priority;
  return 0;
}

TCS_EXPORT int pthread_setschedprio(pthread_t thread, int priority) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(pthread_setschedprio)(thread, priority);
  const pid_t tid = TidOf(thread);
  return tid < 0 ? ESRCH : Set(*t, tid, kKeepPolicy, priority);
}

TCS_EXPORT int sched_setaffinity(pid_t pid, std::size_t size, const cpu_set_t* set) noexcept {
  const Entered t;
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_setaffinity, pid, size, Arg(set))));
  return AsErrno(SetAffinity(*t, pid, size, set));
}

TCS_EXPORT int sched_getaffinity(pid_t pid, std::size_t size, cpu_set_t* set) noexcept {
  const Entered t;
  if (t == nullptr) {
    const long n = ToErrno(RawSyscall(SYS_sched_getaffinity, pid, size, Arg(set)));
    if (n > 0) memset(reinterpret_cast<char*>(set) + n, 0, size - static_cast<std::size_t>(n));
    return n < 0 ? -1 : 0;
  }
  return AsErrno(GetAffinity(*t, pid, size, set));
}

TCS_EXPORT int pthread_setaffinity_np(pthread_t thread, std::size_t size,
                                      const cpu_set_t* set) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(pthread_setaffinity_np)(thread, size, set);
  const pid_t tid = TidOf(thread);
  return tid < 0 ? ESRCH : SetAffinity(*t, tid, size, set);
}

TCS_EXPORT int pthread_getaffinity_np(pthread_t thread, std::size_t size, cpu_set_t* set) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(pthread_getaffinity_np)(thread, size, set);
  const pid_t tid = TidOf(thread);
  return tid < 0 ? ESRCH : GetAffinity(*t, tid, size, set);
}

// Nice values, which the kernel keeps, change no turn: threads of ordinary priority are equals.
TCS_EXPORT int setpriority(__priority_which_t which, id_t who, int value) noexcept {
  Enter();
  return static_cast<int>(ToErrno(RawSyscall(SYS_setpriority, which, who, value)));
}

// As the C library has it: the new value, which may be -1, and EPERM where the kernel says EACCES.
TCS_EXPORT int nice(int increment) noexcept {
  Enter();
  constexpr long kOfNiceZero = 20, kLeast = -20, kMost = 19;
  const long now = kOfNiceZero - RawSyscall(SYS_getpriority, PRIO_PROCESS, 0);
  const long wanted = std::clamp(now + increment, kLeast, kMost);
  const long error = RawSyscall(SYS_setpriority, PRIO_PROCESS, 0, wanted);
  if (error < 0) return Fail(error == -EACCES ? EPERM : static_cast<int>(-error));
  return static_cast<int>(wanted);
}

TCS_EXPORT int sched_yield(void) noexcept {
  const Entered t;
  if (t == nullptr) return static_cast<int>(RawSyscall(SYS_sched_yield));
  YieldCounted(*t, reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)));
  return 0;
}
