// New processes and the ends of old ones. Children register themselves: the shim is in their
// environment.
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "libtcs_preload/environment.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/preemption.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"
#include "libtcs_preload/shown_usage.h"
#include "libtcs_preload/signal_actions.h"
#include "libtcs_preload/spawn.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;
using tcs::shm::NotificationKind;

extern char** environ;

namespace tcs::preload {

// A handler may make a thread or a process, too, while the thread does.
void BeginAnnouncement(GuestThread* thread) {
  if (thread != nullptr) thread->slot->announces.fetch_add(1, std::memory_order_relaxed);
}

void EndAnnouncement(GuestThread* thread) {
  if (thread != nullptr) thread->slot->announces.fetch_sub(1, std::memory_order_relaxed);
}

void TellSpawned(GuestThread& t, pid_t pid) {
  if (pid > 0) Exchange(t, Request{.kind = NotificationKind::kSpawned, .args = {pid}});
}

}  // namespace tcs::preload

namespace {

// Makes `probe` (a wait call with WNOHANG) until it has something. `probe` returns 0 for "no child
// has changed yet".
template <class Probe>
long WaitForChild(GuestThread& t, pid_t which, int options, Probe probe) {
  static_assert(WSTOPPED == WUNTRACED);
  const bool stops = (options & (WUNTRACED | WCONTINUED)) != 0;
  HoldForRead(t);
  for (;;) {
    const long found = probe();
    if (found != 0) return found;
    if (IsShutDown()) return -ECHILD;
    const Reply reply = Exchange(t, Request{.kind = NotificationKind::kWaitChild,
                                            .args = {which > 0 ? which : 0, stops ? 1 : 0},
                                            .interruptible = true});
    if (reply.reason == tcs::shm::WakeReason::kSignal) {
      const long now = probe();
      if (now != 0) return now;
      if (!RestartsAfterSignal()) return -EINTR;
    }
  }
}

// Shows the charge of a child that has ended, instead of what the host has measured.
void ShowChildUsage(GuestThread& t, pid_t child, rusage* usage) {
  const Reply reply = Exchange(t, Request{.kind = NotificationKind::kChildUsage, .args = {child}});
  if (reply.values[0] >= 0) ChargeInsteadOfMeasure(usage, reply.values[0]);
}

// 0 or an errno.
int OpenPidfd(pid_t child, int* pidfd) {
  const long opened = RawSyscall(SYS_pidfd_open, child, 0);
  if (opened < 0) return static_cast<int>(-opened);
  *pidfd = static_cast<int>(opened);
  return 0;
}

// `real()` is posix_spawn or posix_spawnp.
template <class Real>
int SpawnWithShim(Real real, pid_t* pid, const char* program,
                  const posix_spawn_file_actions_t* actions, const posix_spawnattr_t* attributes,
                  char* const argv[], char* const envp[]) {
  const Entered t;
  const EnvironmentWithShim environment(envp);
  const Announcement announcement(t);
  pid_t child = 0;
  const int error = real()(&child, program, actions, attributes, argv, environment.get());
  if (pid != nullptr && error == 0) *pid = child;
  if (t != nullptr && error == 0) TellSpawned(*t, child);
  return error;
}

}  // namespace

TCS_EXPORT pid_t fork(void) noexcept {
  const Entered t;
  BeginAnnouncement(t);
  const pid_t pid = TCS_REAL(fork)();
  if (pid == 0) {
    Current();  // the child comes to its own slot, and stops until it is dispatched
  } else if (t != nullptr) {
    TellSpawned(*t, pid);
    EndAnnouncement(t);
  }
  return pid;
}

// A child that shares its parent's memory would share its clock, too. POSIX lets vfork be fork.
TCS_EXPORT pid_t vfork(void) noexcept { return fork(); }

TCS_EXPORT pid_t wait4(pid_t pid, int* status, int options, rusage* usage) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<pid_t>(
        ToErrno(RawSyscall(SYS_wait4, pid, Arg(status), options, Arg(usage))));
  }
  int found_status = 0;
  const auto probe = [&] {
    return RawSyscall(SYS_wait4, pid, Arg(&found_status), options | WNOHANG, Arg(usage));
  };
  long found;
  if ((options & WNOHANG) != 0) {
    HoldForRead(*t);
    found = probe();
  } else {
    found = WaitForChild(*t, pid, options, probe);
  }
  if (found > 0 && usage != nullptr && (WIFEXITED(found_status) || WIFSIGNALED(found_status))) {
    ShowChildUsage(*t, static_cast<pid_t>(found), usage);
  }
  if (found > 0 && status != nullptr && !CopyOut(status, found_status)) return Fail(EFAULT);
  return static_cast<pid_t>(ToErrno(found));
}

TCS_EXPORT pid_t wait3(int* status, int options, rusage* usage) {
  return wait4(-1, status, options, usage);
}

TCS_EXPORT pid_t waitpid(pid_t pid, int* status, int options) {
  return wait4(pid, status, options, nullptr);
}

TCS_EXPORT pid_t wait(int* status) { return wait4(-1, status, 0, nullptr); }

namespace {

// A descriptor of a process that says EAGAIN rather than wait (PIDFD_NONBLOCK).
bool NeverWaits(idtype_t type, id_t id) {
  constexpr idtype_t kOfDescriptor =
      static_cast<idtype_t>(3);  // P_PIDFD, which glibc has since 2.36
  if (type != kOfDescriptor) return false;
  const long flags = RawSyscall(SYS_fcntl, static_cast<int>(id), F_GETFL);
  return flags < 0 || (flags & O_NONBLOCK) != 0;
}

}  // namespace

TCS_EXPORT int waitid(idtype_t type, id_t id, siginfo_t* info, int options) {
  const Entered t;
  if (t == nullptr || (options & WNOHANG) != 0 || NeverWaits(type, id)) {
    return static_cast<int>(ToErrno(RawSyscall(SYS_waitid, type, id, Arg(info), options, 0)));
  }
  siginfo_t found{};
  const long result =
      WaitForChild(*t, type == P_PID ? static_cast<pid_t>(id) : 0, options, [&]() -> long {
        found.si_pid = 0;
        const long error = RawSyscall(SYS_waitid, type, id, Arg(&found), options | WNOHANG, 0);
        return error != 0 ? error : found.si_pid;
      });
  if (result < 0) return static_cast<int>(ToErrno(result));
  return info == nullptr || CopyOut(info, found) ? 0 : Fail(EFAULT);
}

TCS_EXPORT int execve(const char* path, char* const argv[], char* const envp[]) noexcept {
  const EnvironmentWithShim environment(envp);
  const WithoutPreemption none;
  return static_cast<int>(
      ToErrno(RawSyscall(SYS_execve, Arg(path), Arg(argv), Arg(environment.get()))));
}

TCS_EXPORT int execv(const char* path, char* const argv[]) noexcept {
  return execve(path, argv, environ);
}

TCS_EXPORT int execvpe(const char* file, char* const argv[], char* const envp[]) noexcept {
  const EnvironmentWithShim environment(envp);
  const WithoutPreemption none;
  return TCS_REAL(execvpe)(file, argv, environment.get());
}

TCS_EXPORT int execvp(const char* file, char* const argv[]) noexcept {
  return execvpe(file, argv, environ);
}

TCS_EXPORT int fexecve(int fd, char* const argv[], char* const envp[]) noexcept {
  const EnvironmentWithShim environment(envp);
  const WithoutPreemption none;
  return TCS_REAL(fexecve)(fd, argv, environment.get());
}

TCS_EXPORT int posix_spawn(pid_t* pid, const char* path, const posix_spawn_file_actions_t* actions,
                           const posix_spawnattr_t* attributes, char* const argv[],
                           char* const envp[]) noexcept {
  return SpawnWithShim([] { return TCS_REAL(posix_spawn); }, pid, path, actions, attributes, argv,
                       envp);
}

TCS_EXPORT int posix_spawnp(pid_t* pid, const char* file, const posix_spawn_file_actions_t* actions,
                            const posix_spawnattr_t* attributes, char* const argv[],
                            char* const envp[]) noexcept {
  return SpawnWithShim([] { return TCS_REAL(posix_spawnp); }, pid, file, actions, attributes, argv,
                       envp);
}

// The functions that are new in glibc 2.39, by the functions that there were before.
extern "C" {
TCS_EXPORT int pidfd_spawn(int* pidfd, const char* path, const posix_spawn_file_actions_t* actions,
                           const posix_spawnattr_t* attributes, char* const argv[],
                           char* const envp[]) noexcept {
  pid_t child = 0;
  const int error = posix_spawn(&child, path, actions, attributes, argv, envp);
  return error != 0 ? error : OpenPidfd(child, pidfd);
}

TCS_EXPORT int pidfd_spawnp(int* pidfd, const char* file, const posix_spawn_file_actions_t* actions,
                            const posix_spawnattr_t* attributes, char* const argv[],
                            char* const envp[]) noexcept {
  pid_t child = 0;
  const int error = posix_spawnp(&child, file, actions, attributes, argv, envp);
  return error != 0 ? error : OpenPidfd(child, pidfd);
}
}
