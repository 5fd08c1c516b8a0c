// A library to preload, as libfaketime and proxychains are: it stands before functions of the C
// library, and hands each call on to the next library's other name for that function. Where that
// leads back here the program ends.
#include <dlfcn.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/timex.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdlib>

namespace {

thread_local int t_depth = 0;

// A handler may call what it has interrupted.
constexpr int kMostDepth = 20;

template <class F>
class HandOn {
 public:
  HandOn(const char* own, const char* next) : own_(own), next_(next) {}

  template <class... Arguments>
  auto operator()(Arguments... arguments) {
    if (function_ == nullptr) function_ = reinterpret_cast<F*>(dlsym(RTLD_NEXT, next_));
    if (function_ == nullptr) End("there is no such function");
    if (++t_depth > kMostDepth) End("it leads back to where it came from");
    const auto result = function_(arguments...);
    --t_depth;
    return result;
  }

 private:
  [[noreturn]] void End(const char* why) const {
    fprintf(stderr, "%s handed on to %s: %s\n", own_, next_, why);
    abort();
  }

  const char *own_, *next_;
  F* function_ = nullptr;
};

}  // namespace

#define HAND_ON(result, name, next, parameters, ...)                         \
  extern "C" __attribute__((visibility("default"))) result name parameters { \
    static HandOn<result parameters> hand_on(#name, #next);                  \
    return hand_on(__VA_ARGS__);                                             \
  }

HAND_ON(int, clock_gettime, __clock_gettime, (clockid_t id, timespec* t), id, t)
HAND_ON(int, gettimeofday, __gettimeofday, (timeval * t, void* zone), t, zone)
HAND_ON(int, adjtimex, __adjtimex, (timex * t), t)
HAND_ON(int, nanosleep, __nanosleep, (const timespec* t, timespec* rest), t, rest)
HAND_ON(int, select, __select, (int n, fd_set* r, fd_set* w, fd_set* e, timeval* t), n, r, w, e, t)
HAND_ON(int, poll, __poll, (pollfd * fds, nfds_t count, int timeout), fds, count, timeout)
HAND_ON(ssize_t, read, __read, (int fd, void* to, size_t size), fd, to, size)
HAND_ON(ssize_t, write, __write, (int fd, const void* from, size_t size), fd, from, size)
HAND_ON(ssize_t, send, __send, (int fd, const void* from, size_t size, int flags), fd, from, size,
        flags)
HAND_ON(int, connect, __connect, (int fd, const sockaddr* to, socklen_t size), fd, to, size)
HAND_ON(int, close, __close, (int fd), fd)
HAND_ON(int, dup2, __dup2, (int from, int to), from, to)
HAND_ON(pid_t, fork, __fork, ())
HAND_ON(pid_t, wait, __wait, (int* status), status)
HAND_ON(pid_t, waitpid, __waitpid, (pid_t pid, int* status, int options), pid, status, options)
HAND_ON(FILE*, popen, _IO_popen, (const char* command, const char* mode), command, mode)
HAND_ON(int, sched_yield, __sched_yield, ())
HAND_ON(int, sched_getparam, __sched_getparam, (pid_t pid, sched_param* to), pid, to)
HAND_ON(int, sched_getscheduler, __sched_getscheduler, (pid_t pid), pid)
HAND_ON(int, sched_setscheduler, __sched_setscheduler,
        (pid_t pid, int policy, const sched_param* to), pid, policy, to)
HAND_ON(int, sigaction, __sigaction,
        (int number, const struct sigaction* to, struct sigaction* from), number, to, from)
HAND_ON(int, sigsuspend, __sigsuspend, (const sigset_t* mask), mask)
HAND_ON(long, sysconf, __sysconf, (int name), name)
