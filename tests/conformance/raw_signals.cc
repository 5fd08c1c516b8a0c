// Signals sent by system calls made raw, to threads and processes that sleep, wait for descriptors,
// for a lock or for the signal.
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

constexpr std::int64_t kSent = 100 * kMs;

int g_handled = 0;
std::int64_t g_start = 0, g_handled_at = 0;
pid_t g_waiter = 0;

void Handle(int) {
  ++g_handled;
  g_handled_at = Now() - g_start;
}

void ExpectHandledAt(std::int64_t wanted, const char* what) {
  EXPECT(g_handled == 1, "%s: %d handlers ran", what, g_handled);
  g_handled = 0;
  EXPECT(g_handled_at >= wanted, "%s: handled at %lld", what, (long long)g_handled_at);
  // The sender computes on, and may have its turn first, of a millisecond and a half at most.
  const std::int64_t most = g_mode == Mode::kNative     ? 10 * kSecond
                            : g_mode == Mode::kMeasured ? 10 * kMs
                                                        : 3 * kMs / 2 + 20 * kCallNs;
  EXPECT(g_handled_at < wanted + most, "%s: handled at %lld", what, (long long)g_handled_at);
}

siginfo_t Queued() {
  siginfo_t info{};
  info.si_signo = SIGUSR1;
  info.si_code = SI_QUEUE;
  info.si_pid = getpid();
  info.si_uid = getuid();
  return info;
}

using Send = long (*)();

const struct {
  const char* name;
  Send send;
} kSends[] = {
    {"kill", [] { return syscall(SYS_kill, getpid(), SIGUSR1); }},
    {"tkill", [] { return syscall(SYS_tkill, g_waiter, SIGUSR1); }},
    {"tgkill", [] { return syscall(SYS_tgkill, getpid(), g_waiter, SIGUSR1); }},
    {"rt_sigqueueinfo",
     [] {
       siginfo_t info = Queued();
       return syscall(SYS_rt_sigqueueinfo, getpid(), SIGUSR1, &info);
     }},
    {"rt_tgsigqueueinfo",
     [] {
       siginfo_t info = Queued();
       return syscall(SYS_rt_tgsigqueueinfo, getpid(), g_waiter, SIGUSR1, &info);
     }},
    {"pidfd_send_signal",
     [] {
       const long fd = syscall(SYS_pidfd_open, getpid(), 0);
       const long result = syscall(SYS_pidfd_send_signal, fd, SIGUSR1, nullptr, 0);
       close(static_cast<int>(fd));
       return result;
     }},
};

void SleepUntilItIsSent() {
  const timespec until = ToTimespec(g_start + kSent);
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

// A thread that blocks the signal sends it, then computes on.
void* SendLater(void* send) {
  SleepUntilItIsSent();
  NativelyUntil([] { return Sleeps(g_waiter); });
  EXPECT(reinterpret_cast<Send>(send)() == 0, "send: %s", strerror(errno));
  for (const std::int64_t end = Now() + 3 * kMs; Now() < end;) {
  }
  return nullptr;
}

// While the first thread is in `wait`, which must return as interrupted.
template <class Wait>
void DuringWait(const char* what, Wait wait) {
  for (const auto& [name, send] : kSends) {
    sigset_t set, before;
    sigemptyset(&set);
    sigaddset(&set, SIGUSR1);
    pthread_sigmask(SIG_BLOCK, &set, &before);
    g_start = Now();
    pthread_t thread;
    pthread_create(&thread, nullptr, SendLater, reinterpret_cast<void*>(send));
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    errno = 0;
    EXPECT(wait() == -1 && errno == EINTR, "%s in %s: %s", name, what, strerror(errno));
    pthread_join(thread, nullptr);
    ExpectHandledAt(kSent, name);
  }
}

void ToOthers() {
  for (const int number : {SYS_kill, SYS_tkill}) {
    g_start = Now();
    const pid_t child = fork();
    if (child == 0) {
      EXPECT(usleep(2'000'000) == -1, "not interrupted");
      ExpectHandledAt(kSent, "a child");
      _exit(0);
    }
    SleepUntilItIsSent();
    NativelyUntil([=] { return Sleeps(child); });
    EXPECT(syscall(number, child, SIGUSR1) == 0, "%s", strerror(errno));
    int status = 0;
    EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %x", status);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  struct sigaction action {};
  action.sa_handler = Handle;
  sigaction(SIGUSR1, &action, nullptr);
  g_waiter = static_cast<pid_t>(syscall(SYS_gettid));
  DuringWait("usleep", [] { return usleep(900'000); });
  DuringWait("raw nanosleep", [] {
    const timespec t{0, 900'000'000};
    return static_cast<int>(syscall(SYS_nanosleep, &t, nullptr));
  });
  DuringWait("poll", [] { return poll(nullptr, 0, 900); });
  DuringWait("raw poll", [] { return static_cast<int>(syscall(SYS_poll, nullptr, 0, 900)); });
  sem_t semaphore;
  sem_init(&semaphore, 0, 0);
  DuringWait("sem_wait", [&] { return sem_wait(&semaphore); });
  DuringWait("pause", pause);
  ToOthers();
}
