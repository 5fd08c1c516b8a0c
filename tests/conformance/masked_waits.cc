// Waits with a signal mask of their own: a signal that the mask lets in ends them, be it pending
// before, sent during the wait or by a timer; and where a descriptor is ready no handler runs.
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

namespace {

using namespace conformance;

constexpr std::int64_t kForEver = -1;

int g_handled = 0;
bool g_other_blocked = false;  // in the handler
std::int64_t g_handled_at = 0;

void Handle(int) {
  ++g_handled;
  sigset_t now;
  sigprocmask(SIG_SETMASK, nullptr, &now);
  g_other_blocked = sigismember(&now, SIGUSR2) == 1;
  g_handled_at = Now();
}

// One of the calls: waits for `fd` to be readable, with the mask, for so long.
using Wait = int (*)(int fd, const sigset_t* mask, std::int64_t timeout_ns);

int Ppoll(int fd, const sigset_t* mask, std::int64_t ns) {
  pollfd waited{fd, POLLIN, 0};
  const timespec t = ToTimespec(ns);
  return ppoll(&waited, 1, ns < 0 ? nullptr : &t, mask);
}

int RawPpoll(int fd, const sigset_t* mask, std::int64_t ns) {
  pollfd waited{fd, POLLIN, 0};
  timespec t = ToTimespec(ns);
  return static_cast<int>(syscall(SYS_ppoll, &waited, 1, ns < 0 ? nullptr : &t, mask, 8));
}

int Pselect(int fd, const sigset_t* mask, std::int64_t ns) {
  fd_set set;
  FD_ZERO(&set);
  FD_SET(fd, &set);
  const timespec t = ToTimespec(ns);
  return pselect(fd + 1, &set, nullptr, nullptr, ns < 0 ? nullptr : &t, mask);
}

int RawPselect(int fd, const sigset_t* mask, std::int64_t ns) {
  fd_set set;
  FD_ZERO(&set);
  FD_SET(fd, &set);
  timespec t = ToTimespec(ns);
  const struct {
    const sigset_t* mask;
    std::size_t size;
  } argument{mask, 8};
  return static_cast<int>(
      syscall(SYS_pselect6, fd + 1, &set, nullptr, nullptr, ns < 0 ? nullptr : &t, &argument));
}

template <class Call>
int WithEpoll(int fd, Call call) {
  const int set = epoll_create1(0);
  epoll_event event{};
  event.events = EPOLLIN;
  epoll_ctl(set, EPOLL_CTL_ADD, fd, &event);
  const int found = call(set, &event);
  const int error = errno;
  close(set);
  errno = error;
  return found;
}

int EpollPwait(int fd, const sigset_t* mask, std::int64_t ns) {
  return WithEpoll(fd, [&](int set, epoll_event* event) {
    return epoll_pwait(set, event, 1, ns < 0 ? -1 : static_cast<int>(ns / kMs), mask);
  });
}

int RawEpollPwait(int fd, const sigset_t* mask, std::int64_t ns) {
  return WithEpoll(fd, [&](int set, epoll_event* event) {
    return static_cast<int>(
        syscall(SYS_epoll_pwait, set, event, 1, ns < 0 ? -1 : static_cast<int>(ns / kMs), mask, 8));
  });
}

int EpollPwait2(int fd, const sigset_t* mask, std::int64_t ns) {
  return WithEpoll(fd, [&](int set, epoll_event* event) {
    const timespec t = ToTimespec(ns);
    return epoll_pwait2(set, event, 1, ns < 0 ? nullptr : &t, mask);
  });
}

sigset_t Only(int signal) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  return set;
}

void ExpectHandled(const char* what, int times) {
  EXPECT(g_handled == times, "%s: %d handlers ran", what, g_handled);
  if (times > 0) EXPECT(g_other_blocked, "%s: the handler ran without the mask", what);
  sigset_t now;
  sigprocmask(SIG_SETMASK, nullptr, &now);
  EXPECT(sigismember(&now, SIGUSR1) == 1 && sigismember(&now, SIGUSR2) == 0, "%s: the mask is lost",
         what);
  g_handled = 0;
  g_other_blocked = false;
}

void Check(const char* what, Wait wait, bool is_epoll) {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  const sigset_t other = Only(SIGUSR2);

  // Pending before: it ends the wait at once, also one of no length, but not epoll's.
  for (const std::int64_t length : {kForEver, 50 * kMs}) {
    raise(SIGUSR1);
    const std::int64_t start = Now();
    EXPECT(wait(ends[0], &other, length) == -1 && errno == EINTR, "%s: %s", what, strerror(errno));
    ExpectPassed(start, 0, what);
    ExpectHandled(what, 1);
  }
  raise(SIGUSR1);
  const int found = wait(ends[0], &other, 0);
  if (is_epoll) {
    EXPECT(found == 0, "%s: %d", what, found);
    ExpectHandled(what, 0);
    EXPECT(wait(ends[0], &other, kForEver) == -1 && errno == EINTR, "%s", what);
  } else {
    EXPECT(found == -1 && errno == EINTR, "%s: %d", what, found);
  }
  ExpectHandled(what, 1);

  // What is ready goes first, and the signal stays pending.
  raise(SIGUSR1);
  EXPECT(write(ends[1], "x", 1) == 1, "write");
  EXPECT(wait(ends[0], &other, kForEver) == 1, "%s: %s", what, strerror(errno));
  ExpectHandled(what, 0);
  char byte;
  EXPECT(read(ends[0], &byte, 1) == 1, "read");
  EXPECT(wait(ends[0], &other, kForEver) == -1 && errno == EINTR, "%s", what);
  ExpectHandled(what, 1);

  // Sent while it waits.
  const pid_t parent = getpid();
  std::int64_t start = Now();
  pid_t child = fork();
  if (child == 0) {
    usleep(30'000);
    _exit(kill(parent, SIGUSR1));
  }
  EXPECT(wait(ends[0], &other, kForEver) == -1 && errno == EINTR, "%s: %s", what, strerror(errno));
  ExpectPassed(start, 30 * kMs, what, MostOfChildren());
  EXPECT(g_handled_at - start >= 30 * kMs, "%s: handled early", what);
  ExpectHandled(what, 1);
  EXPECT(waitpid(child, nullptr, 0) == child, "waitpid");

  // By a timer.
  start = Now();
  itimerval timer{{0, 0}, {0, 40'000}};
  setitimer(ITIMER_REAL, &timer, nullptr);
  EXPECT(wait(ends[0], &other, kForEver) == -1 && errno == EINTR, "%s: %s", what, strerror(errno));
  ExpectPassed(start, 40 * kMs, what);
  ExpectHandled(what, 1);

  // What the mask blocks does not, nor does what is ignored.
  const sigset_t both = [] {
    sigset_t set = Only(SIGUSR1);
    sigaddset(&set, SIGUSR2);
    return set;
  }();
  raise(SIGUSR1);
  raise(SIGWINCH);
  start = Now();
  EXPECT(wait(ends[0], &both, 20 * kMs) == 0, "%s: %s", what, strerror(errno));
  ExpectPassed(start, 20 * kMs, what);
  ExpectHandled(what, 0);
  EXPECT(wait(ends[0], &other, kForEver) == -1, "%s", what);
  ExpectHandled(what, 1);

  // And input ends it.
  start = Now();
  child = fork();
  if (child == 0) {
    usleep(30'000);
    _exit(write(ends[1], "x", 1) == 1 ? 0 : 1);
  }
  EXPECT(wait(ends[0], &other, kSecond) == 1, "%s: %s", what, strerror(errno));
  ExpectPassed(start, 30 * kMs, what, MostOfChildren());
  EXPECT(waitpid(child, nullptr, 0) == child, "waitpid");
  ExpectHandled(what, 0);
  close(ends[0]);
  close(ends[1]);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  struct sigaction action {};
  action.sa_handler = Handle;
  sigaction(SIGUSR1, &action, nullptr);
  sigaction(SIGALRM, &action, nullptr);
  sigset_t blocked = Only(SIGUSR1);
  sigaddset(&blocked, SIGALRM);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  Check("ppoll", Ppoll, false);
  Check("pselect", Pselect, false);
  Check("epoll_pwait", EpollPwait, true);
  Check("epoll_pwait2", EpollPwait2, true);
  Check("raw ppoll", RawPpoll, false);
  Check("raw pselect6", RawPselect, false);
  Check("raw epoll_pwait", RawEpollPwait, true);
}
