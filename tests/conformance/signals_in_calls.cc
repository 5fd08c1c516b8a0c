// A signal that the kernel sends by itself, in any instant, to a thread that makes calls which
// never wait: none of them ends with EINTR, though the handler has no SA_RESTART. And a program
// finds the actions of its signals as it has set them.
#include <fcntl.h>
#include <linux/futex.h>
#include <pthread.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kRounds = 60, kCalls = 40;

volatile sig_atomic_t g_handled = 0;
void Count(int) { g_handled = g_handled + 1; }
void CountWithInfo(int signal, siginfo_t* info, void*) {
  if (info->si_signo == signal) g_handled = g_handled + 1;
}

struct sigaction ActionOf(int signal) {
  struct sigaction action {};
  EXPECT(sigaction(signal, nullptr, &action) == 0, "sigaction");
  return action;
}

bool IsMasked(int signal, int other) {
  const sigset_t mask = ActionOf(signal).sa_mask;
  return sigismember(&mask, other) == 1;
}

void ExpectFlags(int signal, int flags, const char* what) {
  constexpr int kLooked = SA_RESTART | SA_SIGINFO | SA_NODEFER | SA_RESETHAND | SA_ONSTACK;
  const int found = ActionOf(signal).sa_flags & kLooked;
  EXPECT(found == flags, "%s has the flags %x, not %x", what, found, flags);
}

// The C library advises against it.
int Interrupts(int signal, bool whether) {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
  return siginterrupt(signal, whether ? 1 : 0);
#pragma GCC diagnostic pop
}

void ActionsAreShownAsTheyWereSet() {
  EXPECT(signal(SIGUSR1, Count) == SIG_DFL, "signal");
  ExpectFlags(SIGUSR1, SA_RESTART, "signal");
  EXPECT(ActionOf(SIGUSR1).sa_handler == Count, "another handler");
  EXPECT(IsMasked(SIGUSR1, SIGUSR1), "its mask");

  struct sigaction action {
  }, before{};
  action.sa_sigaction = CountWithInfo;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  sigaddset(&action.sa_mask, SIGHUP);
  EXPECT(sigaction(SIGUSR1, &action, &before) == 0, "sigaction");
  EXPECT(before.sa_handler == Count && (before.sa_flags & SA_RESTART) != 0, "the one before");
  ExpectFlags(SIGUSR1, SA_SIGINFO | SA_NODEFER, "sigaction");
  EXPECT(ActionOf(SIGUSR1).sa_sigaction == CountWithInfo, "another handler");
  EXPECT(IsMasked(SIGUSR1, SIGHUP), "its mask");
  const int handled = g_handled;
  raise(SIGUSR1);
  EXPECT(g_handled == handled + 1, "%d handlers ran", int(g_handled - handled));

  EXPECT(Interrupts(SIGUSR1, false) == 0, "siginterrupt");
  ExpectFlags(SIGUSR1, SA_SIGINFO | SA_NODEFER | SA_RESTART, "siginterrupt");
  EXPECT(Interrupts(SIGUSR1, true) == 0, "siginterrupt");
  EXPECT(reinterpret_cast<void*>(signal(SIGUSR1, Count)) == reinterpret_cast<void*>(CountWithInfo),
         "signal");
  ExpectFlags(SIGUSR1, 0, "signal after siginterrupt");
  EXPECT(Interrupts(SIGUSR1, false) == 0, "siginterrupt");

  EXPECT(sysv_signal(SIGUSR1, Count) == Count, "sysv_signal");
  ExpectFlags(SIGUSR1, SA_RESETHAND | SA_NODEFER, "sysv_signal");
  raise(SIGUSR1);
  EXPECT(ActionOf(SIGUSR1).sa_handler == SIG_DFL, "it stays");
  EXPECT(sigaction(SIGUSR1, &before, nullptr) == 0, "sigaction");
  EXPECT(signal(SIGUSR1, SIG_IGN) == Count && signal(SIGUSR1, SIG_DFL) == SIG_IGN, "signal");

  EXPECT(sigaction(SIGKILL, &before, nullptr) == -1 && errno == EINVAL, "SIGKILL");
  EXPECT(sigaction(0, nullptr, &before) == -1 && errno == EINVAL, "0");
  EXPECT(signal(65, Count) == SIG_ERR && errno == EINVAL, "65");
}

// None of them waits, and none fails.
void Call(int file) {
  static int word = 0;
  const long woken = syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
  EXPECT(woken == 0, "FUTEX_WAKE: %s", strerror(errno));
  EXPECT(syscall(SYS_sched_yield) == 0, "sched_yield: %s", strerror(errno));
  EXPECT(syscall(SYS_write, file, "x", 1, 0, 0, 0) == 1, "write: %s", strerror(errno));
}

void CallsThatNeverWaitDoNotFail() {
  struct sigaction action {};
  action.sa_handler = Count;
  EXPECT(sigaction(SIGCHLD, &action, nullptr) == 0, "sigaction");
  const int file = open("/dev/null", O_WRONLY);
  g_handled = 0;
  for (int round = 0; round < kRounds; ++round) {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    for (int i = 0; i < kCalls; ++i) Call(file);
    pid_t ended;
    while ((ended = waitpid(child, nullptr, 0)) < 0 && errno == EINTR) {
    }
    EXPECT(ended == child, "waitpid: %s", strerror(errno));
  }
  EXPECT(g_handled > 0, "no handler has run");
  close(file);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  ActionsAreShownAsTheyWereSet();
  CallsThatNeverWaitDoNotFail();
}
