// Scheduling calls speak of the virtual computer: the robot's cores and its scheduler, never the
// host's.
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <stdarg.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"

using namespace tcs::preload;
using tcs::shm::NotificationKind;

namespace {

bool IsSelf(const GuestThread& t, pid_t pid) {
  return pid == 0 || pid == t.slot->tid || pid == t.slot->pid;
}

bool IsRealTime(int policy) { return policy == SCHED_FIFO || policy == SCHED_RR; }

bool IsValid(int policy, int priority) {
  if (IsRealTime(policy)) return priority >= 1 && priority <= 99;
  return (policy == SCHED_OTHER || policy == SCHED_BATCH || policy == SCHED_IDLE) && priority == 0;
}

int SetOwn(GuestThread& t, int policy, int priority) {
  policy &= ~SCHED_RESET_ON_FORK;
  if (!IsValid(policy, priority)) return EINVAL;
  Exchange(t, Request{.kind = NotificationKind::kPriority, .args = {policy, priority}});
  return 0;
}

std::size_t FillAffinity(const GuestThread& t, std::size_t size, cpu_set_t* set) {
  memset(set, 0, size);
  for (std::size_t core = 0; core < t.slot->cores && core < size * 8; ++core) {
    CPU_SET_S(core, size, set);
  }
  return size < 8 ? size : 8;
}

}  // namespace

TCS_EXPORT int sched_setscheduler(pid_t pid, int policy, const sched_param* param) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_setscheduler, pid, policy, Arg(param))));
  if (!IsSelf(*t, pid)) return 0;  // others' priorities come with threads
  const int error = SetOwn(*t, policy, param->sched_priority);
  return error == 0 ? 0 : Fail(error);
}

TCS_EXPORT int sched_getscheduler(pid_t pid) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr) return static_cast<int>(ToErrno(RawSyscall(SYS_sched_getscheduler, pid)));
  return IsSelf(*t, pid) ? t->slot->policy : SCHED_OTHER;
}

TCS_EXPORT int sched_setparam(pid_t pid, const sched_param* param) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_setparam, pid, Arg(param))));
  return sched_setscheduler(pid, t->slot->policy, param);
}

TCS_EXPORT int sched_getparam(pid_t pid, sched_param* param) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_getparam, pid, Arg(param))));
  param->sched_priority = IsSelf(*t, pid) ? t->slot->priority : 0;
  return 0;
}

TCS_EXPORT int pthread_setschedparam(pthread_t thread, int policy,
                                     const sched_param* param) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr) return TCS_REAL(pthread_setschedparam)(thread, policy, param);
  if (!pthread_equal(thread, pthread_self()))
    return IsValid(policy, param->sched_priority) ? 0 : EINVAL;
  return SetOwn(*t, policy, param->sched_priority);
}

TCS_EXPORT int pthread_getschedparam(pthread_t thread, int* policy, sched_param* param) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr) return TCS_REAL(pthread_getschedparam)(thread, policy, param);
  const bool self = pthread_equal(thread, pthread_self()) != 0;
  *policy = self ? t->slot->policy : SCHED_OTHER;
  param->sched_priority = self ? t->slot->priority : 0;
  return 0;
}

TCS_EXPORT int pthread_setschedprio(pthread_t thread, int priority) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr) return TCS_REAL(pthread_setschedprio)(thread, priority);
  const sched_param param{priority};
  return pthread_setschedparam(thread, t->slot->policy, &param);
}

TCS_EXPORT int sched_setaffinity(pid_t pid, std::size_t size, const cpu_set_t* set) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_sched_setaffinity, pid, size, Arg(set))));
  for (std::size_t core = 0; core < t->slot->cores; ++core) {
    if (CPU_ISSET_S(core, size, set)) return 0;
  }
  return Fail(EINVAL);  // none of the robot's cores
}

TCS_EXPORT int sched_getaffinity(pid_t pid, std::size_t size, cpu_set_t* set) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr) {
    const long n = ToErrno(RawSyscall(SYS_sched_getaffinity, pid, size, Arg(set)));
    if (n > 0) memset(reinterpret_cast<char*>(set) + n, 0, size - static_cast<std::size_t>(n));
    return n < 0 ? -1 : 0;
  }
  FillAffinity(*t, size, set);
  return 0;
}

TCS_EXPORT int pthread_setaffinity_np(pthread_t, std::size_t size, const cpu_set_t* set) noexcept {
  return sched_setaffinity(0, size, set) == 0 ? 0 : errno;
}

TCS_EXPORT int pthread_getaffinity_np(pthread_t, std::size_t size, cpu_set_t* set) noexcept {
  return sched_getaffinity(0, size, set) == 0 ? 0 : errno;
}

TCS_EXPORT int setpriority(__priority_which_t which, id_t who, int value) noexcept {
  if (Enter() != nullptr) return 0;
  return static_cast<int>(ToErrno(RawSyscall(SYS_setpriority, which, who, value)));
}

TCS_EXPORT int nice(int) noexcept {
  errno = 0;
  return 0;
}

TCS_EXPORT int sched_yield(void) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr) return static_cast<int>(RawSyscall(SYS_sched_yield));
  Exchange(*t, Request{.kind = NotificationKind::kYield});
  return 0;
}

TCS_EXPORT int sched_getcpu(void) noexcept {
  GuestThread* t = Enter();
  if (t != nullptr) return static_cast<int>(t->slot->core);
  unsigned cpu = 0;
  RawSyscall(SYS_getcpu, Arg(&cpu), 0, 0);
  return static_cast<int>(cpu);
}

TCS_EXPORT int getcpu(unsigned* cpu, unsigned* node) noexcept {
  GuestThread* t = Enter();
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_getcpu, Arg(cpu), Arg(node), 0)));
  if (cpu != nullptr) *cpu = t->slot->core;
  if (node != nullptr) *node = 0;
  return 0;
}

TCS_EXPORT int get_nprocs(void) noexcept {
  GuestThread* t = Enter();
  return t != nullptr ? static_cast<int>(t->slot->cores) : TCS_REAL(get_nprocs)();
}

TCS_EXPORT int get_nprocs_conf(void) noexcept {
  GuestThread* t = Enter();
  return t != nullptr ? static_cast<int>(t->slot->cores) : TCS_REAL(get_nprocs_conf)();
}

TCS_EXPORT long sysconf(int name) noexcept {
  if (name == _SC_NPROCESSORS_ONLN || name == _SC_NPROCESSORS_CONF) {
    GuestThread* t = Enter();
    if (t != nullptr) return static_cast<long>(t->slot->cores);
  }
  return TCS_REAL(sysconf)(name);
}
