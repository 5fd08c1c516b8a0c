// pause and sigsuspend end with the handler of a signal.
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "tests/conformance/alarm_in.h"
#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

volatile sig_atomic_t g_count = 0;
void Count(int) { g_count = g_count + 1; }

void ExpectAbout(std::int64_t start, std::int64_t wanted, const char* what) {
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= wanted, "%s ended after %lld ns", what, (long long)passed);
  if (g_mode != Mode::kNative)
    EXPECT(passed < wanted + (g_mode == Mode::kFixed ? 1 : 10) * kMs, "%s: %lld ns", what,
           (long long)passed);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  signal(SIGALRM, Count);
  std::int64_t start = Now();
  AlarmIn(80 * kMs);
  EXPECT(pause() == -1 && errno == EINTR, "pause");
  ExpectAbout(start, 80 * kMs, "pause");
  EXPECT(g_count == 1, "%d handlers ran", int(g_count));

  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGALRM);
  sigprocmask(SIG_BLOCK, &blocked, &before);
  start = Now();
  AlarmIn(60 * kMs);
  usleep(20'000);
  EXPECT(g_count == 1, "a blocked signal was handled");
  EXPECT(sigsuspend(&before) == -1 && errno == EINTR, "sigsuspend");
  ExpectAbout(start, 60 * kMs, "sigsuspend");
  EXPECT(g_count == 2, "%d handlers ran", int(g_count));

  // One that is pending already ends it at once.
  AlarmIn(10 * kMs);
  usleep(50'000);
  start = Now();
  EXPECT(sigsuspend(&before) == -1 && errno == EINTR, "sigsuspend");
  ExpectAbout(start, 0, "sigsuspend with a pending signal");
  EXPECT(g_count == 3, "%d handlers ran", int(g_count));

  // A pending one that is ignored does not: the wait goes on until a handler has run.
  sigaddset(&blocked, SIGCHLD);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitid(P_PID, static_cast<id_t>(child), nullptr, WEXITED);
  start = Now();
  AlarmIn(70 * kMs);
  EXPECT(sigsuspend(&before) == -1 && errno == EINTR, "sigsuspend");
  ExpectAbout(start, 70 * kMs, "sigsuspend with a pending signal that is ignored");
  EXPECT(g_count == 4, "%d handlers ran", int(g_count));

  // Made raw.
  start = Now();
  AlarmIn(40 * kMs);
  EXPECT(syscall(SYS_rt_sigsuspend, &before, 8) == -1 && errno == EINTR, "rt_sigsuspend");
  ExpectAbout(start, 40 * kMs, "rt_sigsuspend");
  EXPECT(g_count == 5, "%d handlers ran", int(g_count));
  // A signal of somebody else's, at the time at which it is sent.
  start = Now();
  if (fork() == 0) {
    const timespec until = ToTimespec(start + 60 * kMs);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    kill(getppid(), SIGALRM);
    _exit(0);
  }
  EXPECT(syscall(SYS_rt_sigsuspend, &before, 8) == -1 && errno == EINTR, "rt_sigsuspend");
  ExpectAbout(start, 60 * kMs, "rt_sigsuspend until another process's signal");
  EXPECT(g_count == 6, "%d handlers ran", int(g_count));
  sigprocmask(SIG_SETMASK, &before, nullptr);
  start = Now();
  AlarmIn(30 * kMs);
  EXPECT(syscall(SYS_pause) == -1 && errno == EINTR, "pause");
  ExpectAbout(start, 30 * kMs, "a raw pause");
  EXPECT(g_count == 7, "%d handlers ran", int(g_count));
  sigprocmask(SIG_BLOCK, &blocked, nullptr);

  sigset_t now;
  sigprocmask(SIG_SETMASK, nullptr, &now);
  EXPECT(sigismember(&now, SIGALRM) == 1, "sigsuspend did not put the mask back");
}
