// Sandboxes and launchers: programs that live in namespaces of their own. There they know
// themselves, their threads and their children by other numbers, and find nobody of the computer's
// network. Their time is the robot's all the same.
#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

namespace {

using namespace conformance;

void ExpectEnd(pid_t pid, int code, const char* what) {
  int status = -1;
  EXPECT(waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == code,
         "%s: status %x, %s", what, static_cast<unsigned>(status), strerror(errno));
}

// The child's and the grandchild's first calls that the shim sees.
void Children() {
  const std::int64_t start = Now();
  const pid_t early = fork();
  if (early == 0) {
    usleep(100'000);
    _exit(1);
  }
  const pid_t late = fork();
  if (late == 0) {
    usleep(200'000);
    _exit(2);
  }
  ExpectEnd(late, 2, "a child waited for by its number");
  ExpectSoonAfter(start, 200 * kMs, "its end");
  ExpectEnd(early, 1, "one that has ended before");
  const pid_t killed = fork();
  if (killed == 0) {
    for (;;) pause();
  }
  usleep(50'000);
  int status = 0;
  EXPECT(kill(killed, SIGTERM) == 0, "%s", strerror(errno));
  EXPECT(waitpid(killed, &status, 0) == killed && WTERMSIG(status) == SIGTERM, "%x",
         static_cast<unsigned>(status));
}

struct Inherits {
  pthread_mutex_t lock;
  std::int64_t got = 0;
};

void* LockAndSay(void* of) {
  auto& locked = *static_cast<Inherits*>(of);
  EXPECT(pthread_mutex_lock(&locked.lock) == 0, "lock");
  locked.got = Now();
  EXPECT(pthread_mutex_unlock(&locked.lock) == 0, "unlock");
  return nullptr;
}

// The kernel's locks have the owner's number in them.
void Locks() {
  Inherits locked;
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  EXPECT(pthread_mutex_init(&locked.lock, &attributes) == 0, "init");
  EXPECT(pthread_mutex_lock(&locked.lock) == 0, "lock");
  const std::int64_t start = Now();
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, LockAndSay, &locked) == 0, "create");
  usleep(100'000);
  EXPECT(pthread_mutex_unlock(&locked.lock) == 0, "unlock");
  EXPECT(pthread_join(thread, nullptr) == 0, "join");
  EXPECT(locked.got - start >= 100 * kMs, "got the lock early");
  ExpectPassed(start, 100 * kMs, "a lock that inherits priorities");
}

void* AskForPolicy(void*) {
  sched_param param{};
  int policy = -1;
  EXPECT(pthread_getschedparam(pthread_self(), &policy, &param) == 0 && policy == SCHED_OTHER,
         "policy %d", policy);
  EXPECT(sched_getscheduler(gettid()) == SCHED_OTHER, "%s", strerror(errno));
  timespec cpu;
  clockid_t own;
  EXPECT(pthread_getcpuclockid(pthread_self(), &own) == 0 && clock_gettime(own, &cpu) == 0, "%s",
         strerror(errno));
  usleep(100'000);
  return nullptr;
}

void Threads() {
  const std::int64_t start = Now();
  pthread_t threads[3];
  for (pthread_t& thread : threads) {
    EXPECT(pthread_create(&thread, nullptr, AskForPolicy, nullptr) == 0, "create");
  }
  for (const pthread_t thread : threads) EXPECT(pthread_join(thread, nullptr) == 0, "join");
  ExpectPassed(start, 100 * kMs, "threads");
}

// A timer whose signal is for one thread, by its number there.
void Timers() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGRTMIN);
  sigprocmask(SIG_BLOCK, &set, nullptr);
  sigevent event{};
  event.sigev_notify = SIGEV_THREAD_ID;
  event.sigev_signo = SIGRTMIN;
  event._sigev_un._tid = gettid();
  timer_t timer;
  EXPECT(timer_create(CLOCK_MONOTONIC, &event, &timer) == 0, "%s", strerror(errno));
  const std::int64_t start = Now();
  itimerspec once{};
  once.it_value = ToTimespec(100 * kMs);
  EXPECT(timer_settime(timer, 0, &once, nullptr) == 0, "%s", strerror(errno));
  siginfo_t info;
  EXPECT(sigwaitinfo(&set, &info) == SIGRTMIN, "%s", strerror(errno));
  ExpectPassed(start, 100 * kMs, "a timer of a thread");
  timer_delete(timer);
}

void Live() {
  EXPECT(getpid() == 1 && gettid() == 1, "%d", getpid());
  const std::int64_t start = Now();
  usleep(100'000);
  ExpectPassed(start, 100 * kMs, "a sleep");
  Children();
  Threads();
  Locks();
  Timers();
  EXPECT(system("sleep 0.1") == 0, "a program");
}

// As launchers do it: by a process that leaves namespaces, and forks. Where that is not permitted
// nothing is tested.
void In(int flags, const char* what) {
  constexpr int kNotPermitted = 77;
  const std::int64_t start = Now();
  const pid_t launcher = fork();
  if (launcher == 0) {
    if (unshare(flags | CLONE_NEWUSER) != 0) _exit(kNotPermitted);
    const pid_t pid = fork();
    if (pid == 0) {
      Live();
      _exit(0);
    }
    ExpectEnd(pid, 0, what);
    _exit(0);
  }
  int status = -1;
  EXPECT(waitpid(launcher, &status, 0) == launcher && WIFEXITED(status), "%s: %x", what,
         static_cast<unsigned>(status));
  if (WEXITSTATUS(status) == kNotPermitted) return;
  EXPECT(WEXITSTATUS(status) == 0, "%s: %x", what, static_cast<unsigned>(status));
  // Seven processes, two programs and a network are made: where it is measured that is the host's.
  ExpectSoonAfter(start, 750 * kMs, what, (g_mode == Mode::kMeasured ? 500 : 60) * kMs);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  In(CLONE_NEWPID, "in a PID namespace");
  In(CLONE_NEWPID | CLONE_NEWNET, "in a network, too");
}
