// A thread sends signals, and is preempted at any instant of it, to threads that wait for a lock
// that lends priority. Handlers run, and nobody takes that for having the lock, nor loses it.
#include <pthread.h>
#include <sched.h>
#include <signal.h>

#include <atomic>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kLockers = 4, kSignals = 3'000;

pthread_mutex_t g_mutex;
std::atomic<int> g_inside{0}, g_handled{0};
std::atomic<bool> g_done{false};

void* Lock(void*) {
  while (!g_done) {
    EXPECT(pthread_mutex_lock(&g_mutex) == 0, "pthread_mutex_lock");
    EXPECT(g_inside.exchange(1) == 0, "two threads have the lock");
    usleep(20);
    EXPECT(g_inside.exchange(0) == 1, "two threads had the lock");
    EXPECT(pthread_mutex_unlock(&g_mutex) == 0, "pthread_mutex_unlock");
  }
  return nullptr;
}

// More urgent than the sender, where that is allowed.
void* Preempt(void*) {
  const sched_param param{50};
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
  for (unsigned i = 0; !g_done; ++i) {
    const timespec pause = ToTimespec(3'000 + i * 7919 % 10'000);
    nanosleep(&pause, nullptr);
  }
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  struct sigaction action {};
  action.sa_handler = [](int) { ++g_handled; };
  sigaction(SIGUSR1, &action, nullptr);
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  pthread_mutex_init(&g_mutex, &attributes);
  pthread_t lockers[kLockers], preempting;
  for (pthread_t& locker : lockers) pthread_create(&locker, nullptr, Lock, nullptr);
  pthread_create(&preempting, nullptr, Preempt, nullptr);
  for (int i = 0; i < kSignals; ++i) {
    EXPECT(pthread_kill(lockers[i % kLockers], SIGUSR1) == 0, "pthread_kill");
    if (i % 16 == 0) usleep(100);
  }
  g_done = true;
  for (const pthread_t locker : lockers) pthread_join(locker, nullptr);
  pthread_join(preempting, nullptr);
  EXPECT(g_handled > 0, "no handler has run");
}
