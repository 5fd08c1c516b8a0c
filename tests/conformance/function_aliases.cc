// The other names under which the C library's functions go, in its own headers, in older programs
// and in other libraries: they do the same.
#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/timeb.h>
#include <sys/timex.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <threads.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

// Null where this C library has no such name.
template <class F>
F* Named(const char* name) {
  return reinterpret_cast<F*>(dlsym(RTLD_DEFAULT, name));
}

void Sleeps() {
  const timespec wanted = ToTimespec(20 * kMs);
  std::int64_t start = Now();
  EXPECT(thrd_sleep(&wanted, nullptr) == 0, "thrd_sleep");
  ExpectWaited(start, 20 * kMs, 2, "thrd_sleep");
  if (auto* alias = Named<decltype(nanosleep)>("__nanosleep"); alias != nullptr) {
    start = Now();
    EXPECT(alias(&wanted, nullptr) == 0, "__nanosleep");
    ExpectWaited(start, 20 * kMs, 2, "__nanosleep");
  }
  if (auto* alias = Named<decltype(clock_nanosleep)>("__clock_nanosleep"); alias != nullptr) {
    start = Now();
    EXPECT(alias(CLOCK_MONOTONIC, 0, &wanted, nullptr) == 0, "__clock_nanosleep");
    ExpectWaited(start, 20 * kMs, 2, "__clock_nanosleep");
  }
  if (auto* alias = Named<decltype(select)>("__select"); alias != nullptr) {
    start = Now();
    timeval timeout{0, 20'000};
    EXPECT(alias(0, nullptr, nullptr, nullptr, &timeout) == 0, "__select");
    ExpectWaited(start, 20 * kMs, 2, "__select");
  }
}

// Two ends of a pair, under the aliases.
void Descriptors() {
  auto* const alias_read = Named<decltype(read)>("__read");
  auto* const alias_write = Named<decltype(write)>("__write");
  auto* const alias_send = Named<decltype(send)>("__send");
  auto* const alias_poll = Named<decltype(poll)>("__poll");
  auto* const alias_close = Named<decltype(close)>("__close");
  auto* const alias_dup2 = Named<decltype(dup2)>("__dup2");
  auto* const alias_connect = Named<decltype(connect)>("__connect");
  int fds[2];
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, fds) == 0, "socketpair");
  pollfd polled{fds[1], POLLIN, 0};
  const std::int64_t start = Now();
  EXPECT(alias_poll(&polled, 1, 20) == 0, "__poll");
  ExpectWaited(start, 20 * kMs, 2, "__poll");
  char text[4];
  EXPECT(alias_write(fds[0], "ab", 2) == 2 && alias_send(fds[0], "cd", 2, 0) == 2,
         "__write, __send");
  EXPECT(alias_poll(&polled, 1, -1) == 1 && alias_read(fds[1], text, 4) == 4, "__read");
  EXPECT(alias_dup2(fds[0], 500) == 500 && alias_close(500) == 0 && alias_close(500) == -1,
         "__close");
  sockaddr_un nobody{AF_UNIX, "/nonexistent"};
  const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT(alias_connect(fd, reinterpret_cast<sockaddr*>(&nobody), sizeof nobody) == -1 &&
             errno == ENOENT,
         "__connect");
}

// What the fortified headers call where the compiler does not know the room.
void Fortified() {
  auto* const checked_poll = Named<int(pollfd*, nfds_t, int, std::size_t)>("__poll_chk");
  auto* const checked_ppoll =
      Named<int(pollfd*, nfds_t, const timespec*, const sigset_t*, std::size_t)>("__ppoll_chk");
  auto* const checked_read = Named<ssize_t(int, void*, std::size_t, std::size_t)>("__read_chk");
  auto* const checked_recv =
      Named<ssize_t(int, void*, std::size_t, std::size_t, int)>("__recv_chk");
  auto* const checked_recvfrom =
      Named<ssize_t(int, void*, std::size_t, std::size_t, int, sockaddr*, socklen_t*)>(
          "__recvfrom_chk");
  int fds[2];
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, fds) == 0, "socketpair");
  pollfd polled{fds[1], POLLIN, 0};
  std::int64_t start = Now();
  EXPECT(checked_poll(&polled, 1, 20, sizeof polled) == 0, "__poll_chk");
  ExpectWaited(start, 20 * kMs, 2, "__poll_chk");
  start = Now();
  const timespec timeout = ToTimespec(20 * kMs);
  EXPECT(checked_ppoll(&polled, 1, &timeout, nullptr, sizeof polled) == 0, "__ppoll_chk");
  ExpectWaited(start, 20 * kMs, 2, "__ppoll_chk");
  // Each waits for what a child writes later.
  start = Now();
  const pid_t pid = fork();
  if (pid == 0) {
    for (int i = 0; i < 3; ++i) {
      usleep(20'000);
      if (write(fds[0], "z", 1) != 1) _exit(1);
    }
    _exit(0);
  }
  char c[4];
  EXPECT(checked_read(fds[1], c, 1, sizeof c) == 1, "__read_chk");
  EXPECT(checked_recv(fds[1], c, 1, sizeof c, 0) == 1, "__recv_chk");
  EXPECT(checked_recvfrom(fds[1], c, 1, sizeof c, 0, nullptr, nullptr) == 1, "__recvfrom_chk");
  ExpectSoonAfter(start, 60 * kMs, "three bytes");
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "child status %x", status);
}

void Processes() {
  auto* const alias_wait = Named<decltype(wait)>("__wait");
  auto* const alias_waitpid = Named<decltype(waitpid)>("__waitpid");
  std::int64_t start = Now();
  pid_t pid = Named<decltype(fork)>("__fork")();
  if (pid == 0) {
    usleep(40'000);
    _exit(3);
  }
  int status = 0;
  EXPECT(alias_waitpid(pid, &status, 0) == pid && status == 3 << 8, "__waitpid: %x", status);
  ExpectSoonAfter(start, 40 * kMs, "a child");
  if (g_mode != Mode::kNative) {  // a true vfork cannot be called by a pointer
    pid = Named<decltype(vfork)>("__vfork")();
    if (pid == 0) _exit(4);
    EXPECT(alias_wait(&status) == pid && status == 4 << 8, "__wait: %x", status);
  }
  start = Now();
  FILE* out = Named<decltype(popen)>("_IO_popen")("sleep 0.1; echo done", "r");
  char line[8] = "";
  EXPECT(out != nullptr && fgets(line, sizeof line, out) != nullptr, "_IO_popen");
  EXPECT(pclose(out) == 0, "pclose");
  ExpectSoonAfter(start, 100 * kMs, "pclose", 300 * kMs);
}

void Scheduling() {
  sched_param param{};
  EXPECT(Named<decltype(sched_getparam)>("__sched_getparam")(0, &param) == 0, "__sched_getparam");
  const int policy = Named<decltype(sched_getscheduler)>("__sched_getscheduler")(0);
  EXPECT(policy == sched_getscheduler(0), "__sched_getscheduler: %d", policy);
  EXPECT(Named<decltype(sched_setscheduler)>("__sched_setscheduler")(0, policy, &param) == 0,
         "__sched_setscheduler");
  EXPECT(Named<decltype(sched_yield)>("__sched_yield")() == 0, "__sched_yield");
  thrd_yield();
  if (auto* old = Named<decltype(sched_yield)>("pthread_yield"); old != nullptr) {
    EXPECT(old() == 0, "pthread_yield");
  }
  EXPECT(
      Named<decltype(sysconf)>("__sysconf")(_SC_NPROCESSORS_ONLN) == sysconf(_SC_NPROCESSORS_ONLN),
      "__sysconf");
}

void Threads() {
  const std::int64_t start = Now();
  thrd_t threads[3];
  int result = 0;
  for (thrd_t& thread : threads) {
    const int error = thrd_create(
        &thread,
        [](void* argument) {
          usleep(60'000);
          if (argument != nullptr) thrd_exit(-7);
          return -7;
        },
        &thread == threads ? &thread : nullptr);
    EXPECT(error == thrd_success, "thrd_create: %d", error);
  }
  for (const thrd_t thread : threads) {
    EXPECT(thrd_join(thread, &result) == thrd_success && result == -7, "thrd_join: %d", result);
  }
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= 60 * kMs, "three threads took %lld ns", (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < (g_mode == Mode::kFixed ? 61 : 75) * kMs, "three threads took %lld ns",
           (long long)passed);
  }
}

volatile sig_atomic_t g_alarms = 0;

void Alarms() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_alarms = g_alarms + 1; };
  sigaction(SIGALRM, &action, nullptr);
  EXPECT(ualarm(900'000, 0) == 0, "no alarm was set");
  const useconds_t left = ualarm(30'000, 0);
  EXPECT(left > 800'000 && left <= 900'000, "ualarm says %u us were left", left);
  const std::int64_t start = Now();
  EXPECT(usleep(500'000) == -1 && errno == EINTR && g_alarms == 1, "an alarm did not come");
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= 29 * kMs && passed < 400 * kMs, "ualarm after %lld ns", (long long)passed);
  // It comes into the wait, and not before.
  sigset_t none, blocked;
  sigemptyset(&none);
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGALRM);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  ualarm(30'000, 0);
  EXPECT(Named<decltype(sigsuspend)>("__sigsuspend")(&none) == -1 && g_alarms == 2, "__sigsuspend");
}

void Clocks() {
  if (auto* alias = Named<decltype(clock_gettime)>("__clock_gettime"); alias != nullptr) {
    const std::int64_t before = Now();
    timespec now;
    EXPECT(alias(CLOCK_MONOTONIC, &now) == 0, "__clock_gettime");
    EXPECT(before <= ToNs(now) && ToNs(now) <= Now(), "__clock_gettime: %lld",
           (long long)ToNs(now));
  }
  if (auto* alias = Named<decltype(clock_getres)>("__clock_getres"); alias != nullptr) {
    timespec resolution;
    EXPECT(alias(CLOCK_MONOTONIC, &resolution) == 0 && ToNs(resolution) > 0, "__clock_getres");
  }
  const std::int64_t before = Now(CLOCK_REALTIME);
  if (auto* alias = Named<int(timeval*, void*)>("__gettimeofday"); alias != nullptr) {
    timeval now;
    EXPECT(alias(&now, nullptr) == 0, "__gettimeofday");
    const std::int64_t ns = now.tv_sec * kSecond + now.tv_usec * 1000;
    EXPECT(before / 1000 * 1000 <= ns && ns <= Now(CLOCK_REALTIME), "__gettimeofday: %lld",
           (long long)ns);
  }
  if (auto* old = Named<int(struct timeb*)>("ftime"); old != nullptr) {
    struct timeb now {};
    EXPECT(old(&now) == 0, "ftime");
    const std::int64_t ns = now.time * kSecond + now.millitm * kMs;
    EXPECT(before - 20 * kMs <= ns && ns <= Now(CLOCK_REALTIME), "ftime: %lld", (long long)ns);
  }
}

void Signals() {
  struct sigaction now {};
  for (const char* name : {"bsd_signal", "ssignal"}) {
    EXPECT(Named<decltype(signal)>(name)(SIGUSR2, [](int) {}) != SIG_ERR, "%s", name);
    EXPECT(Named<decltype(sigaction)>("__sigaction")(SIGUSR2, nullptr, &now) == 0, "__sigaction");
    EXPECT((now.sa_flags & (SA_RESTART | SA_SIGINFO)) == SA_RESTART, "%s: %x", name, now.sa_flags);
  }
  EXPECT(Named<decltype(sysv_signal)>("__sysv_signal")(SIGUSR2, SIG_DFL) == now.sa_handler,
         "__sysv_signal");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Sleeps();
  Clocks();
  Descriptors();
  Fortified();
  Processes();
  Scheduling();
  Threads();
  Signals();
  Alarms();
}
