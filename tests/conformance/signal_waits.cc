// sigwait, sigwaitinfo and sigtimedwait, whoever sends: a timer, the thread itself, another thread,
// another process, the end of a child.
#include <pthread.h>
#include <signal.h>
#include <sys/time.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/alarm_in.h"
#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

using namespace conformance;

namespace {

volatile sig_atomic_t g_handled = 0;
void Count(int) { g_handled = g_handled + 1; }

sigset_t SetOf(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  return set;
}

// Never early; under tcs late by no more than calls cost.
void ExpectPassed(std::int64_t start, std::int64_t wanted, const char* what) {
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= wanted, "%s took %lld ns", what, (long long)passed);
  if (g_mode == Mode::kMeasured)
    EXPECT(passed < wanted + 5 * kMs, "%s: %lld ns", what, (long long)passed);
  if (g_mode == Mode::kFixed)
    EXPECT(passed <= wanted + 10 * kCallNs, "%s: %lld ns", what, (long long)passed);
}

void Deadlines() {
  const sigset_t set = SetOf({SIGUSR1, SIGRTMIN + 1});
  siginfo_t info{};
  timespec timeout = ToTimespec(40 * kMs);
  std::int64_t start = Now();
  EXPECT(sigtimedwait(&set, &info, &timeout) == -1 && errno == EAGAIN, "nobody sent");
  ExpectWaited(start, 40 * kMs, 2, "sigtimedwait");
  timeout = {};
  start = Now();
  EXPECT(sigtimedwait(&set, &info, &timeout) == -1 && errno == EAGAIN, "nobody sent");
  ExpectWaited(start, 0, 2, "sigtimedwait without a wait");
  timeout = {0, 1'000'000'000};
  EXPECT(sigtimedwait(&set, &info, &timeout) == -1 && errno == EINVAL, "a bad time");

  // What is pending is there at once, the smallest number first, each of those with a queue.
  sigval value{};
  for (value.sival_int = 1; value.sival_int <= 2; ++value.sival_int) {
    EXPECT(sigqueue(getpid(), SIGRTMIN + 1, value) == 0, "sigqueue: %s", strerror(errno));
  }
  raise(SIGUSR1);
  EXPECT(sigwaitinfo(&set, &info) == SIGUSR1, "SIGUSR1 first");
  for (int i = 1; i <= 2; ++i) {
    EXPECT(sigwaitinfo(&set, &info) == SIGRTMIN + 1, "a queued one");
    EXPECT(info.si_code == SI_QUEUE && info.si_value.sival_int == i && info.si_pid == getpid(),
           "code %d, value %d", info.si_code, info.si_value.sival_int);
  }
}

void FromTimers() {
  const sigset_t set = SetOf({SIGALRM});
  std::int64_t start = Now();
  AlarmIn(70 * kMs);
  int found = 0;
  EXPECT(sigwait(&set, &found) == 0 && found == SIGALRM, "sigwait");
  ExpectPassed(start, 70 * kMs, "sigwait");

  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGRTMIN + 1;
  event.sigev_value.sival_int = 12;
  timer_t timer;
  EXPECT(timer_create(CLOCK_MONOTONIC, &event, &timer) == 0, "timer_create");
  start = Now();
  const itimerspec spec{ToTimespec(10 * kMs), ToTimespec(10 * kMs)};
  timer_settime(timer, 0, &spec, nullptr);
  const sigset_t timers = SetOf({SIGRTMIN + 1});
  for (int i = 1; i <= 20; ++i) {
    siginfo_t info{};
    EXPECT(sigwaitinfo(&timers, &info) == SIGRTMIN + 1, "sigwaitinfo: %s", strerror(errno));
    EXPECT(info.si_code == SI_TIMER && info.si_value.sival_int == 12, "code %d", info.si_code);
    if (g_mode != Mode::kNative) EXPECT(info.si_overrun == 0, "%d overruns", info.si_overrun);
    if (g_mode != Mode::kNative) ExpectPassed(start, i * 10 * kMs, "a period");
  }
  timer_delete(timer);
}

// A handler of another signal ends the wait, except for sigwait.
void Interrupted() {
  struct sigaction action {};
  action.sa_handler = Count;
  action.sa_flags = SA_RESTART;
  sigaction(SIGVTALRM, &action, nullptr);
  const sigset_t set = SetOf({SIGUSR1});
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGVTALRM;
  timer_t timer;
  EXPECT(timer_create(CLOCK_REALTIME, &event, &timer) == 0, "timer_create");
  // Natively a busy machine may be late for the wait.
  const std::int64_t soon = (g_mode == Mode::kNative ? 300 : 30) * kMs;
  const itimerspec spec{{0, 0}, ToTimespec(soon)};
  std::int64_t start = Now();
  timer_settime(timer, 0, &spec, nullptr);
  timespec timeout = ToTimespec(10 * kSecond);
  EXPECT(sigtimedwait(&set, nullptr, &timeout) == -1 && errno == EINTR, "sigtimedwait: %s",
         strerror(errno));
  ExpectPassed(start, soon, "sigtimedwait until a handler");
  EXPECT(g_handled == 1, "%d handlers ran", int(g_handled));
  timer_settime(timer, 0, &spec, nullptr);
  EXPECT(sigwaitinfo(&set, nullptr) == -1 && errno == EINTR, "sigwaitinfo");
  EXPECT(g_handled == 2, "%d handlers ran", int(g_handled));
  start = Now();
  timer_settime(timer, 0, &spec, nullptr);
  const sigset_t alarms = SetOf({SIGALRM});
  AlarmIn(2 * soon);
  int found = 0;
  EXPECT(sigwait(&alarms, &found) == 0 && found == SIGALRM, "sigwait");
  ExpectPassed(start, 2 * soon, "sigwait over a handler");
  EXPECT(g_handled == 3, "%d handlers ran", int(g_handled));
  timer_delete(timer);
}

void FromProcesses() {
  // Back and forth, each after a sleep.
  const sigset_t set = SetOf({SIGUSR1, SIGUSR2});
  const pid_t parent = getpid();
  std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    for (int i = 0; i < 5; ++i) {
      usleep(10'000);
      kill(parent, SIGUSR1);
      siginfo_t info;
      if (sigwaitinfo(&set, &info) != SIGUSR2 || info.si_pid != parent) _exit(1);
    }
    _exit(0);
  }
  for (int i = 1; i <= 5; ++i) {
    siginfo_t info{};
    EXPECT(sigwaitinfo(&set, &info) == SIGUSR1 && info.si_pid == child, "from %d", info.si_pid);
    const std::int64_t passed = Now() - start;
    EXPECT(passed >= i * 10 * kMs, "round %d after %lld ns", i, (long long)passed);
    if (g_mode != Mode::kNative)
      EXPECT(passed < i * 11 * kMs + MostOfChildren(), "round %d after %lld ns", i,
             (long long)passed);
    kill(child, SIGUSR2);
  }
  int status = -1;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "the child: %x", status);

  // The end of a child.
  const sigset_t ends = SetOf({SIGCHLD});
  const timespec now{};
  while (sigtimedwait(&ends, nullptr, &now) > 0) {
  }
  start = Now();
  const pid_t sleeper = fork();
  if (sleeper == 0) {
    usleep(50'000);
    _exit(3);
  }
  siginfo_t info{};
  EXPECT(sigwaitinfo(&ends, &info) == SIGCHLD && info.si_pid == sleeper && info.si_status == 3,
         "SIGCHLD of %d", info.si_pid);
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= 50 * kMs, "after %lld ns", (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < 50 * kMs + MostOfChildren(), "after %lld ns", (long long)passed);
  }
  waitpid(sleeper, nullptr, 0);

  // Killed while it sleeps, it is gone at the killer's time.
  const pid_t victim = fork();
  if (victim == 0) {
    for (;;) pause();
  }
  usleep(20'000);
  start = Now();
  kill(victim, SIGTERM);
  EXPECT(waitpid(victim, &status, 0) == victim && WTERMSIG(status) == SIGTERM, "%x", status);
  if (g_mode == Mode::kFixed) ExpectPassed(start, 0, "killing");
  ExpectSoonAfter(start, 0, "killing");
}

// A program's one thread for signals.
std::atomic<int> g_received{0};
std::int64_t g_received_at = 0;

void* Receive(void*) {
  const sigset_t set = SetOf({SIGUSR1, SIGUSR2, SIGTERM});
  for (;;) {
    int found = 0;
    if (sigwait(&set, &found) != 0) continue;
    g_received_at = Now();
    ++g_received;
    if (found == SIGTERM) return nullptr;
  }
}

void ExpectReceived(int count, std::int64_t sent, const char* what) {
  usleep(5'000);
  NativelyUntil([=] { return g_received >= count; });
  EXPECT(g_received == count, "%s: %d were received", what, g_received.load());
  if (g_mode == Mode::kMeasured)
    EXPECT(g_received_at - sent < 4 * kMs, "%s: %lld ns later", what,
           (long long)(g_received_at - sent));
  if (g_mode == Mode::kFixed)
    EXPECT(g_received_at - sent <= 5 * kCallNs, "%s: %lld ns later", what,
           (long long)(g_received_at - sent));
}

void FromThreads() {
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, Receive, nullptr) == 0, "pthread_create");
  usleep(10'000);
  std::int64_t sent = Now();
  pthread_kill(thread, SIGUSR1);
  ExpectReceived(1, sent, "pthread_kill");
  sent = Now();
  kill(getpid(), SIGUSR2);
  ExpectReceived(2, sent, "kill");
  sent = Now();
  pthread_sigqueue(thread, SIGUSR2, sigval{});
  ExpectReceived(3, sent, "pthread_sigqueue");
  sent = Now();
  kill(getpid(), SIGTERM);
  pthread_join(thread, nullptr);
  EXPECT(g_received == 4, "%d were received", g_received.load());
  EXPECT(pthread_kill(pthread_self(), 0) == 0, "a probe");
  EXPECT(kill(getpid(), 65) == -1 && errno == EINVAL, "a bad signal");
}

// A handler that runs in a thread that sleeps, at the sender's time.
std::int64_t g_handled_at = 0;
void NoteTime(int) { g_handled_at = Now(); }

std::atomic<pid_t> g_sleeper{0};

void* SleepLong(void*) {
  g_sleeper = gettid();
  const timespec wanted = ToTimespec(3600 * kSecond);
  timespec left{};
  EXPECT(nanosleep(&wanted, &left) == -1 && errno == EINTR, "nanosleep");
  return nullptr;
}

void ToAHandler() {
  signal(SIGRTMIN + 6, NoteTime);
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, SleepLong, nullptr) == 0, "pthread_create");
  usleep(30'000);
  NativelyUntil([] { return g_sleeper != 0 && Sleeps(g_sleeper); });
  const std::int64_t sent = Now();
  EXPECT(pthread_kill(thread, SIGRTMIN + 6) == 0, "pthread_kill");
  pthread_join(thread, nullptr);
  EXPECT(g_handled_at >= sent, "handled %lld ns before", (long long)(sent - g_handled_at));
  if (g_mode != Mode::kNative)
    EXPECT(g_handled_at - sent < (g_mode == Mode::kFixed ? 1 : 5) * kMs, "%lld ns later",
           (long long)(g_handled_at - sent));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  const sigset_t blocked = SetOf({SIGUSR1, SIGUSR2, SIGTERM, SIGALRM, SIGCHLD, SIGRTMIN + 1});
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  Deadlines();
  FromTimers();
  Interrupted();
  sigset_t sigterm = SetOf({SIGTERM});
  sigprocmask(SIG_UNBLOCK, &sigterm, nullptr);
  FromProcesses();
  sigprocmask(SIG_BLOCK, &sigterm, nullptr);
  FromThreads();
  ToAHandler();
}
