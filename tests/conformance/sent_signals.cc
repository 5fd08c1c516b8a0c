// A signal that another process sends ends a wait, runs a handler or ends a process at the time it
// was sent.
#include <poll.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

using namespace conformance;

namespace {

constexpr std::int64_t kDelay = 30 * kMs;

void SleepUntil(std::int64_t until) {
  const timespec t = ToTimespec(until);
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

std::int64_t g_handled_ns = 0;
int g_count = 0, g_value = 0;
int g_steps = 0;  // that the handler computes before its first call
volatile double g_computed = 0;
void Handle(int, siginfo_t* info, void*) {
  for (int i = 0; i < g_steps; ++i) g_computed = g_computed * 0.5 + 1;
  g_handled_ns = Now();
  ++g_count;
  g_value = info->si_value.sival_int;
}

void HandleWith(int signal, int flags) {
  struct sigaction action {};
  action.sa_sigaction = Handle;
  action.sa_flags = SA_SIGINFO | flags;
  EXPECT(sigaction(signal, &action, nullptr) == 0, "sigaction");
}

// `wait` is under way when the signal is sent; it must end with an error of EINTR.
void EndsTheWait(const char* what, const std::function<long()>& wait) {
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  const pid_t parent = getpid();
  g_count = 0;
  const pid_t child = fork();
  if (child == 0) {
    usleep(kDelay / 1000);
    NativelyUntil([=] { return Sleeps(parent); });
    const std::int64_t sent = Now();
    kill(parent, SIGUSR1);
    _exit(write(fds[1], &sent, sizeof sent) == sizeof sent ? 0 : 1);
  }
  const std::int64_t start = Now();
  const long result = wait();
  const int error = errno;
  const std::int64_t ended = Now();
  EXPECT(result == -1 && error == EINTR, "%s: %ld, %s", what, result, strerror(error));
  EXPECT(g_count == 1, "%s: %d handlers ran", what, g_count);
  std::int64_t sent = 0;
  EXPECT(read(fds[0], &sent, sizeof sent) == sizeof sent, "read");
  EXPECT(sent <= g_handled_ns && g_handled_ns <= ended, "%s: handled %lld ns early", what,
         (long long)(sent - g_handled_ns));
  if (g_mode != Mode::kNative) {
    const std::int64_t slack_ns = g_steps > 0 ? 500 * kMs : MostOfChildren();
    EXPECT(ended - start < kDelay + slack_ns, "%s: ended after %lld ns", what,
           (long long)(ended - start));
  }
  // Sent, written, waited for the end of the child's turn; the handler's look at the clock, ours.
  if (g_mode == Mode::kFixed) {
    EXPECT(ended - sent == 4 * kCallNs, "%s: ended after %lld ns", what, (long long)(ended - sent));
  }
  EXPECT(waitpid(child, nullptr, 0) == child, "waitpid");
  close(fds[0]);
  close(fds[1]);
}

void Waits() {
  HandleWith(SIGUSR1, 0);
  int fds[2];
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, fds) == 0, "socketpair");
  sem_t semaphore;
  sem_init(&semaphore, 0, 0);
  char c;
  EndsTheWait("usleep", [] { return usleep(100'000); });
  // Some 40 ms, longer than any call takes.
  g_steps = 10'000'000;
  EndsTheWait("usleep, by a handler that computes", [] { return usleep(100'000); });
  g_steps = 0;
  EndsTheWait("pause", [] { return pause(); });
  EndsTheWait("read", [&] { return read(fds[0], &c, 1); });
  EndsTheWait("poll", [&] {
    pollfd fd{fds[0], POLLIN, 0};
    return poll(&fd, 1, 1000);
  });
  EndsTheWait("sem_wait", [&] { return sem_wait(&semaphore); });
  EndsTheWait("sem_timedwait", [&] {
    const timespec deadline = ToTimespec(Now(CLOCK_REALTIME) + kSecond);
    return sem_timedwait(&semaphore, &deadline);
  });
}

// With SA_RESTART the handler runs in the middle, and the wait goes on.
void Restarts() {
  HandleWith(SIGUSR1, SA_RESTART);
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  sem_t* semaphore = static_cast<sem_t*>(
      mmap(nullptr, sizeof(sem_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  sem_init(semaphore, 1, 0);
  const pid_t parent = getpid();
  for (const bool reads : {true, false}) {
    g_count = 0;
    const std::int64_t start = Now();
    const pid_t child = fork();
    if (child == 0) {
      SleepUntil(start + kDelay);
      NativelyUntil([=] { return Sleeps(parent); });
      kill(parent, SIGUSR1);
      SleepUntil(start + 2 * kDelay);
      if (reads) _exit(write(fds[1], "x", 1) == 1 ? 0 : 1);
      _exit(sem_post(semaphore));
    }
    char c;
    EXPECT(reads ? read(fds[0], &c, 1) == 1 : sem_wait(semaphore) == 0, "restarted: %s",
           strerror(errno));
    const std::int64_t passed = Now() - start;
    EXPECT(g_count == 1, "%d handlers ran", g_count);
    EXPECT(g_handled_ns - start >= kDelay && passed >= 2 * kDelay, "handled after %lld ns of %lld",
           (long long)(g_handled_ns - start), (long long)passed);
    if (g_mode != Mode::kNative) {
      EXPECT(g_handled_ns - start < kDelay + 15 * kMs && passed < 2 * kDelay + 15 * kMs,
             "handled after %lld ns of %lld", (long long)(g_handled_ns - start), (long long)passed);
    }
    EXPECT(waitpid(child, nullptr, 0) == child, "waitpid");
  }
}

void Values() {
  HandleWith(SIGRTMIN, 0);
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGRTMIN);
  sigprocmask(SIG_BLOCK, &blocked, &before);
  const pid_t parent = getpid();
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    for (int i = 1; i <= 3; ++i) {
      usleep(10'000);
      sigqueue(parent, SIGRTMIN, sigval{i});
    }
    _exit(0);
  }
  for (int i = 1; i <= 3; ++i) {
    EXPECT(sigsuspend(&before) == -1 && g_value == i, "value %d, not %d", g_value, i);
    ExpectSoonAfter(start, i * 10 * kMs, "a value", 5 * kMs + MostOfChildren());
  }
  EXPECT(waitpid(child, nullptr, 0) == child, "waitpid");
  sigprocmask(SIG_SETMASK, &before, nullptr);
}

pid_t Sleeper() {
  const pid_t child = fork();
  if (child == 0) {
    sleep(1000);
    _exit(0);
  }
  return child;
}

void WasTerminated(pid_t child) {
  int status = 0;
  EXPECT(waitpid(child, &status, WNOHANG) == child && WTERMSIG(status) == SIGTERM, "%x", status);
}

// A child that sleeps for long is ended, and its parent told, in that instant: while the parent
// sleeps, and where the parent keeps the signal until it waits for it, having ended the child
// itself. (If it does not keep it, the child may have ended, and the handler run, before the parent
// sleeps.)
void EndsOfProcesses() {
  HandleWith(SIGCHLD, 0);
  g_count = 0;
  std::int64_t start = Now();
  const pid_t child = Sleeper();
  const pid_t killer = fork();
  if (killer == 0) {
    usleep(kDelay / 1000);
    NativelyUntil([] { return Sleeps(getppid()); });
    EXPECT(kill(child, SIGTERM) == 0, "kill: %s", strerror(errno));
    sleep(1000);
    _exit(0);
  }
  EXPECT(sleep(100) > 0 && g_count == 1, "SIGCHLD did not end the sleep: %d", g_count);
  ExpectSoonAfter(start, kDelay, "the end of a child");
  WasTerminated(child);
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGCHLD);
  sigprocmask(SIG_BLOCK, &blocked, &before);
  start = Now();
  EXPECT(kill(killer, SIGTERM) == 0, "kill: %s", strerror(errno));
  EXPECT(sigsuspend(&before) == -1 && g_count == 2, "%d handlers ran", g_count);
  ExpectSoonAfter(start, 0, "the end of another child");
  WasTerminated(killer);
  sigprocmask(SIG_SETMASK, &before, nullptr);
  signal(SIGCHLD, SIG_DFL);
}

// Stopped for 50 ms, a child does nothing, and then goes on.
void Stops() {
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  const pid_t child = fork();
  if (child == 0) {
    for (;;) {
      usleep(10'000);
      if (write(fds[1], "x", 1) != 1) _exit(1);
    }
  }
  char c;
  EXPECT(read(fds[0], &c, 1) == 1, "read");
  kill(child, SIGSTOP);
  if (g_mode == Mode::kNative) {  // it may have written more before it was seen and stopped
    int status = 0, more = 0;
    EXPECT(waitpid(child, &status, WUNTRACED) == child && WIFSTOPPED(status), "%x", status);
    EXPECT(ioctl(fds[0], FIONREAD, &more) == 0, "FIONREAD");
    for (; more > 0; --more) EXPECT(read(fds[0], &c, 1) == 1, "read");
  }
  const std::int64_t start = Now();
  usleep(50'000);
  kill(child, SIGCONT);
  for (int i = 0; i < 3; ++i) EXPECT(read(fds[0], &c, 1) == 1, "read");
  ExpectSoonAfter(start, 60 * kMs, "a stopped child", 40 * kMs);
  kill(child, SIGKILL);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && WTERMSIG(status) == SIGKILL, "%x", status);
}

std::atomic<pid_t> g_first_tid{0};

// Which thread of `threads` ends its sleep at once, -1 if none does within 30 ms. Thread `taker`
// does not block SIGUSR2; the others do. `waiter` waits for it by sigwait. Natively all is five
// times as long: a busy machine is late.
int WhoTakes(int taker, int waiter,
             const std::function<void(const std::vector<pthread_t>&)>& send) {
  constexpr int kThreads = 4;
  const int times = g_mode == Mode::kNative ? 5 : 1;
  std::atomic<int> who{-1};
  std::atomic<bool> sent{false};
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      if (i == 0) g_first_tid = gettid();
      sigset_t set;
      sigemptyset(&set);
      sigaddset(&set, SIGUSR2);
      pthread_sigmask(i == taker ? SIG_UNBLOCK : SIG_BLOCK, &set, nullptr);
      const timespec long_enough = ToTimespec(times * 80 * kMs);
      const int result = i == waiter ? sigtimedwait(&set, nullptr, &long_enough)
                                     : nanosleep(&long_enough, nullptr);
      if (i == waiter ? result == SIGUSR2 : result == -1) who = i;
      EXPECT(sent, "a wait of 80 ms was over in 20");
    });
  }
  usleep(static_cast<unsigned>(times) * 20'000);
  sent = true;
  std::vector<pthread_t> handles;
  for (std::thread& thread : threads) handles.push_back(thread.native_handle());
  send(handles);
  usleep(static_cast<unsigned>(times) * 30'000);
  const int taken_by = who;
  for (std::thread& thread : threads) thread.join();
  return taken_by;
}

// Of several threads the one that does not block it, wherever it stands; one that waits for it; and
// no other than that which is named.
void AmongThreads() {
  HandleWith(SIGUSR2, 0);
  sigset_t set, before;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR2);
  pthread_sigmask(SIG_BLOCK, &set, &before);
  const auto to_process = [](const std::vector<pthread_t>&) { kill(getpid(), SIGUSR2); };
  for (int taker = 0; taker < 4; ++taker) {
    const int who = WhoTakes(taker, -1, to_process);
    EXPECT(who == taker, "kill: thread %d instead of %d", who, taker);
  }
  const int waiter = WhoTakes(-1, 2, to_process);
  EXPECT(waiter == 2, "kill: thread %d waited for it instead of 2", waiter);
  for (int taker = 0; taker < 4; taker += 3) {
    const int who = WhoTakes(taker, -1, [taker](const std::vector<pthread_t>& threads) {
      EXPECT(pthread_kill(threads[std::size_t(taker)], SIGUSR2) == 0, "pthread_kill");
    });
    EXPECT(who == taker, "pthread_kill: thread %d instead of %d", who, taker);
  }
  const int blocked = WhoTakes(1, -1, [](const std::vector<pthread_t>& threads) {
    EXPECT(pthread_kill(threads[3], SIGUSR2) == 0, "pthread_kill");
  });
  EXPECT(blocked == -1, "pthread_kill of a thread that blocks it: %d took it", blocked);
  const int by_value = WhoTakes(2, -1, [](const std::vector<pthread_t>&) {
    EXPECT(sigqueue(getpid(), SIGUSR2, {.sival_int = 3}) == 0, "sigqueue");
  });
  EXPECT(by_value == 2, "sigqueue: thread %d instead of 2", by_value);
  const int by_tkill = WhoTakes(0, -1, [](const std::vector<pthread_t>&) {
    EXPECT(syscall(SYS_tkill, g_first_tid.load(), SIGUSR2) == 0, "tkill");
  });
  EXPECT(by_tkill == 0, "tkill: thread %d instead of 0", by_tkill);
  // The number of a thread that blocks it stands for its process.
  const int by_number = WhoTakes(3, -1, [](const std::vector<pthread_t>&) {
    EXPECT(kill(g_first_tid, SIGUSR2) == 0, "kill");
  });
  EXPECT(by_number == 3, "kill by a thread's number: thread %d instead of 3", by_number);
  const int by_raw_number = WhoTakes(1, -1, [](const std::vector<pthread_t>&) {
    siginfo_t info{};
    info.si_code = SI_QUEUE;
    EXPECT(syscall(SYS_rt_sigqueueinfo, g_first_tid.load(), SIGUSR2, &info) == 0, "raw");
  });
  EXPECT(by_raw_number == 1, "rt_sigqueueinfo: thread %d instead of 1", by_raw_number);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  EXPECT(kill(getpid(), 0) == 0 && kill(-1, 99) == -1 && errno == EINVAL, "kill of nothing");
  Waits();
  Restarts();
  Values();
  EndsOfProcesses();
  Stops();
  AmongThreads();
}
