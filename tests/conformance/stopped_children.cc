// Children that are stopped and go on: their parents are told by wait calls and by SIGCHLD, at the
// time of the signal, however it was sent.
#include <pthread.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

namespace {

using namespace conformance;

void SleepUntil(std::int64_t until) {
  const timespec t = ToTimespec(until);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

[[noreturn]] void Sleep() {
  for (;;) pause();
}

[[noreturn]] void Compute() {
  for (;;) Now();
}

[[noreturn]] void SleepWithThreads() {
  pthread_t thread;
  for (int i = 0; i < 2; ++i) {
    pthread_create(
        &thread, nullptr, [](void*) -> void* { Sleep(); }, nullptr);
  }
  Sleep();
}

// Another child stops `of` 100 ms after the start, lets it go on after 200, and kills it after 300.
pid_t Controller(pid_t of, std::int64_t start, int stop) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  SleepUntil(start + 100 * kMs);
  EXPECT(kill(of, stop) == 0, "kill");
  SleepUntil(start + 200 * kMs);
  EXPECT(kill(of, SIGCONT) == 0, "kill");
  SleepUntil(start + 300 * kMs);
  EXPECT(kill(of, SIGKILL) == 0, "kill");
  _exit(0);
}

template <class Life>
pid_t Start(Life life) {
  const pid_t pid = fork();
  EXPECT(pid >= 0, "fork");
  if (pid == 0) life();
  return pid;
}

void Reap(pid_t pid) {
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "status %x", status);
}

template <class Life, class Wait>
void ByAnother(const char* what, Life life, int stop, Wait wait) {
  const std::int64_t start = Now();
  const pid_t child = Start(life), controller = Controller(child, start, stop);
  int status = 0;
  EXPECT(wait(child, &status) == child && WIFSTOPPED(status) && WSTOPSIG(status) == stop, "%s: %x",
         what, status);
  ExpectPassed(start, 100 * kMs, what);
  EXPECT(wait(child, &status) == child && WIFCONTINUED(status), "%s: %x", what, status);
  ExpectPassed(start, 200 * kMs, what);
  EXPECT(wait(child, &status) == child && WIFSIGNALED(status), "%s: %x", what, status);
  ExpectPassed(start, 300 * kMs, what, MostOfChildren());
  Reap(controller);
}

pid_t Waitpid(pid_t pid, int* status) { return waitpid(pid, status, WUNTRACED | WCONTINUED); }

pid_t RawWait4(pid_t pid, int* status) {
  return static_cast<pid_t>(syscall(SYS_wait4, pid, status, WUNTRACED | WCONTINUED, nullptr));
}

pid_t Waitid(pid_t pid, int* status) {
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WSTOPPED | WCONTINUED) != 0) return -1;
  const bool stopped = info.si_code == CLD_STOPPED;
  *status = stopped                         ? W_STOPCODE(info.si_status)
            : info.si_code == CLD_CONTINUED ? 0xffff
                                            : info.si_status;
  return info.si_pid;
}

// It stops itself.
void ByItself() {
  for (const bool raw : {false, true}) {
    const std::int64_t start = Now();
    const pid_t child = Start([&] {
      SleepUntil(start + 50 * kMs);
      if (raw) {
        syscall(SYS_kill, getpid(), SIGSTOP);
      } else {
        raise(SIGSTOP);
      }
      // It goes on where it was.
      ExpectPassed(start, 80 * kMs, "going on");
      _exit(7);
    });
    int status = 0;
    EXPECT(waitpid(-1, &status, WUNTRACED) == child && WIFSTOPPED(status), "%x", status);
    ExpectPassed(start, 50 * kMs, "raise");
    EXPECT(waitpid(child, &status, WUNTRACED | WNOHANG) == 0, "told twice");
    SleepUntil(start + 80 * kMs);
    EXPECT(kill(child, SIGCONT) == 0, "kill");
    EXPECT(waitpid(child, &status, 0) == child && WEXITSTATUS(status) == 7, "%x", status);
    ExpectPassed(start, 80 * kMs, "its end");
  }
}

// Who does not ask for stops waits for the end.
void NotAskedFor() {
  const std::int64_t start = Now();
  const pid_t child = Start(Sleep), controller = Controller(child, start, SIGSTOP);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && WIFSIGNALED(status), "%x", status);
  ExpectPassed(start, 300 * kMs, "the end of a child that was stopped", MostOfChildren());
  Reap(controller);
}

volatile int g_signals = 0;

void Signals(int flags, int wanted) {
  struct sigaction action {};
  action.sa_handler = [](int) { g_signals = g_signals + 1; };
  action.sa_flags = flags;
  sigaction(SIGCHLD, &action, nullptr);
  g_signals = 0;
  const std::int64_t start = Now();
  const pid_t child = Start(Sleep);
  const pid_t controller = Controller(child, start, SIGSTOP);
  // The stop, and the going on.
  for (int i = 1; i <= wanted; ++i) {
    EXPECT(usleep(900'000) == -1 && errno == EINTR, "not interrupted");
    ExpectPassed(start, i * 100 * kMs, "SIGCHLD");
    EXPECT(g_signals == i, "%d signals", g_signals);
  }
  while (g_signals == wanted) usleep(900'000);
  ExpectPassed(start, 300 * kMs, "SIGCHLD of the end", MostOfChildren());
  signal(SIGCHLD, SIG_DFL);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && WIFSIGNALED(status), "%x", status);
  Reap(controller);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  ByAnother("a sleeper", Sleep, SIGSTOP, Waitpid);
  ByAnother("one with threads", SleepWithThreads, SIGSTOP, Waitpid);
  ByAnother("waitid", Sleep, SIGSTOP, Waitid);
  ByAnother("wait4 made raw", Sleep, SIGSTOP, RawWait4);
  // Under set costs computing takes no time but by its calls.
  ByAnother("one that computes", Compute, SIGSTOP, Waitpid);
  ByItself();
  NotAskedFor();
  Signals(0, 2);
  Signals(SA_NOCLDSTOP, 0);
}
