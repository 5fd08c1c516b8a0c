// A thread that holds a lock of protocol PTHREAD_PRIO_INHERIT has the priority of the most urgent
// that waits for it. And a robust lock whose owner died passes on, with the news.
#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

pthread_mutex_t g_mutex;
std::atomic<std::int64_t> g_locked_ns, g_middle_done_ns;

bool SetPriority(int priority) {
  const sched_param param{priority};
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) == 0;
}

void ComputeFor(std::int64_t ns) {
  const std::int64_t start = Now(CLOCK_THREAD_CPUTIME_ID);
  while (Now(CLOCK_THREAD_CPUTIME_ID) < start + ns) {
  }
}

void* HoldLock(void*) {
  SetPriority(10);
  pthread_mutex_lock(&g_mutex);
  ComputeFor(10 * kMs);
  pthread_mutex_unlock(&g_mutex);
  return nullptr;
}

void* ComputeBetween(void*) {
  SetPriority(50);
  usleep(3'000);
  ComputeFor(30 * kMs);
  g_middle_done_ns = Now();
  return nullptr;
}

void* WantLock(void*) {
  SetPriority(90);
  usleep(5'000);
  timespec deadline = ToTimespec(Now(CLOCK_REALTIME) + 10 * kSecond);
  EXPECT(pthread_mutex_timedlock(&g_mutex, &deadline) == 0, "timedlock");
  g_locked_ns = Now();
  EXPECT(pthread_mutex_unlock(&g_mutex) == 0, "unlock");
  return nullptr;
}

// Low holds the lock, middle would keep low from ever letting it go, high wants it.
void Invert(int protocol) {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  EXPECT(pthread_mutexattr_setprotocol(&attributes, protocol) == 0, "protocol");
  pthread_mutex_init(&g_mutex, &attributes);
  pthread_t threads[3];
  void* (*const routines[3])(void*) = {HoldLock, ComputeBetween, WantLock};
  SetPriority(99);
  for (int i = 0; i < 3; ++i) pthread_create(&threads[i], nullptr, routines[i], nullptr);
  for (const pthread_t thread : threads) pthread_join(thread, nullptr);
}

void TimeoutIsKept() {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  pthread_mutex_init(&g_mutex, &attributes);
  pthread_mutex_lock(&g_mutex);
  pthread_t thread;
  pthread_create(
      &thread, nullptr,
      [](void*) -> void* {
        EXPECT(pthread_mutex_trylock(&g_mutex) == EBUSY, "trylock");
        const std::int64_t start = Now();
        timespec deadline = ToTimespec(Now(CLOCK_REALTIME) + 70 * kMs);
        EXPECT(pthread_mutex_timedlock(&g_mutex, &deadline) == ETIMEDOUT, "timedlock");
        ExpectSoonAfter(start, 70 * kMs, "giving up");
        return nullptr;
      },
      nullptr);
  pthread_join(thread, nullptr);
  pthread_mutex_unlock(&g_mutex);
}

std::atomic<int> g_handled{0};

// A lock is waited for on, whatever handlers run meanwhile.
void SignalsWhileWaiting() {
  struct sigaction action {};
  action.sa_handler = [](int) { ++g_handled; };
  sigaction(SIGUSR1, &action, nullptr);
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  for (const bool timed : {false, true}) {
    static pthread_mutex_t mutex;
    static bool times;
    static std::atomic<bool> mine;
    times = timed;
    mine = true;
    pthread_mutex_init(&mutex, &attributes);
    pthread_mutex_lock(&mutex);
    const auto lock = [](void*) -> void* {
      timespec deadline;
      clock_gettime(CLOCK_REALTIME, &deadline);
      deadline.tv_sec += 100;
      const int error =
          times ? pthread_mutex_timedlock(&mutex, &deadline) : pthread_mutex_lock(&mutex);
      EXPECT(error == 0, "%s", strerror(error));
      EXPECT(!mine, "two have the lock");
      EXPECT(pthread_mutex_unlock(&mutex) == 0, "unlock");
      return nullptr;
    };
    pthread_t thread;
    pthread_create(&thread, nullptr, lock, nullptr);
    for (int i = 0; i < 3; ++i) {
      usleep(10'000);
      const int before = g_handled;
      pthread_kill(thread, SIGUSR1);
      NativelyUntil([=] { return g_handled > before; });  // two that are there at once are one
    }
    usleep(10'000);
    mine = false;
    pthread_mutex_unlock(&mutex);
    // It has the lock now, and has not gone on yet.
    pthread_kill(thread, SIGUSR1);
    pthread_join(thread, nullptr);
  }
  EXPECT(g_handled >= 6, "%d handlers have run", g_handled.load());
}

struct Owned {
  pthread_mutex_t mutex;
  std::atomic<bool> is_locked;
};

void* LockAndEnd(void* memory) {
  auto* owned = static_cast<Owned*>(memory);
  EXPECT(pthread_mutex_lock(&owned->mutex) == 0, "lock");
  owned->is_locked = true;
  usleep(20'000);
  return nullptr;
}

void OwnerDies(int protocol, bool process) {
  auto* owned = static_cast<Owned*>(
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  pthread_mutex_t* const mutex = &owned->mutex;
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, protocol);
  pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST);
  pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  pthread_mutex_init(mutex, &attributes);
  pid_t child = -1;
  pthread_t thread{};
  const std::int64_t start = Now();
  if (process) {
    child = fork();
    if (child == 0) {
      LockAndEnd(owned);
      _exit(0);
    }
  } else {
    pthread_create(&thread, nullptr, LockAndEnd, owned);
  }
  // The owner's start may take longer than what it then sleeps.
  while (!owned->is_locked) usleep(1'000);
  const int error = pthread_mutex_lock(mutex);
  EXPECT(error == EOWNERDEAD, "protocol %d: %s", protocol, strerror(error));
  ExpectSoonAfter(start, 19 * kMs, "the owner's death");
  EXPECT(pthread_mutex_consistent(mutex) == 0 && pthread_mutex_unlock(mutex) == 0, "consistent");
  if (process) waitpid(child, nullptr, 0);
  if (!process) pthread_join(thread, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  TimeoutIsKept();
  SignalsWhileWaiting();
  for (const int protocol : {PTHREAD_PRIO_NONE, PTHREAD_PRIO_INHERIT}) {
    for (const bool process : {false, true}) OwnerDies(protocol, process);
  }
  if (g_mode == Mode::kNative) return 0;  // needs one processor for all three
  Invert(PTHREAD_PRIO_NONE);
  EXPECT(g_locked_ns > g_middle_done_ns, "without inheritance the middle one comes first");
  Invert(PTHREAD_PRIO_INHERIT);
  EXPECT(g_locked_ns < g_middle_done_ns, "the lock's owner did not inherit");
}
