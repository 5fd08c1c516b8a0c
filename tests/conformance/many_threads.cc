// Many threads at once: mutexes, condition variables, timed waits, sleeps, births and deaths of
// threads, signals, fork and exec. Whatever they do, nobody else is inside a mutex, no wake-up is
// lost, no clock goes back and no wait ends early. It prints what it has done, and a hash of all
// its readings of the clock. After the mode may come for how many ms.
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>
#include <cstdint>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr int kWorkers = 8, kBorn = 4;
std::int64_t g_run = 200 * kMs;

pthread_mutex_t g_mutex = PTHREAD_MUTEX_INITIALIZER, g_lending;
std::atomic<int> g_inside{0}, g_lent{0};
std::int64_t g_entries = 0, g_lent_entries = 0;  // each under its mutex

// A queue between the workers.
pthread_mutex_t g_queue_mutex = PTHREAD_MUTEX_INITIALIZER;
pthread_cond_t g_queue_filled = PTHREAD_COND_INITIALIZER;
int g_queued = 0;
std::int64_t g_put = 0, g_taken = 0;

sem_t g_semaphore;
std::atomic<std::int64_t> g_signals{0};
std::atomic<bool> g_done{false};

struct Worker {
  pthread_t thread;
  unsigned seed;
  std::int64_t last = 0, rounds = 0, hash = 0;

  unsigned Draw(unsigned below) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 16) % below;
  }
  std::int64_t Look() {
    const std::int64_t now = Now();
    EXPECT(now >= last, "the clock went back by %lld ns", (long long)(last - now));
    last = now;
    hash = hash * 31 + now;
    return now;
  }
};

void OnSignal(int) { ++g_signals; }

void Enter(Worker& w) {
  pthread_mutex_lock(&g_mutex);
  EXPECT(g_inside.exchange(1) == 0, "two threads are inside the mutex");
  if (w.Draw(2) == 0) usleep(w.Draw(300));
  ++g_entries;
  EXPECT(g_inside.exchange(0) == 1, "two threads were inside the mutex");
  pthread_mutex_unlock(&g_mutex);
}

void EnterLending(Worker& w) {
  EXPECT(pthread_mutex_lock(&g_lending) == 0, "pthread_mutex_lock");
  EXPECT(g_lent.exchange(1) == 0, "two threads are inside the lending mutex");
  if (w.Draw(2) == 0) usleep(w.Draw(300));
  ++g_lent_entries;
  EXPECT(g_lent.exchange(0) == 1, "two threads were inside the lending mutex");
  EXPECT(pthread_mutex_unlock(&g_lending) == 0, "pthread_mutex_unlock");
}

void Put() {
  pthread_mutex_lock(&g_queue_mutex);
  ++g_queued;
  ++g_put;
  pthread_cond_signal(&g_queue_filled);
  pthread_mutex_unlock(&g_queue_mutex);
}

void TakeUntil(Worker& w) {
  const std::int64_t wait = 100'000 + w.Draw(2'000'000);
  const std::int64_t until = Now(CLOCK_REALTIME) + wait;
  const timespec deadline = ToTimespec(until);
  pthread_mutex_lock(&g_queue_mutex);
  int error = 0;
  while (g_queued == 0 && error == 0) {
    error = pthread_cond_timedwait(&g_queue_filled, &g_queue_mutex, &deadline);
  }
  if (error == ETIMEDOUT) {
    EXPECT(Now(CLOCK_REALTIME) >= until, "a timed wait ended early");
  }
  if (g_queued > 0) {
    --g_queued;
    ++g_taken;
  }
  pthread_mutex_unlock(&g_queue_mutex);
}

void Sleep(Worker& w) {
  const std::int64_t wanted = w.Draw(500'000), start = w.Look();
  timespec left = ToTimespec(wanted);
  while (nanosleep(&left, &left) != 0) EXPECT(errno == EINTR, "nanosleep: %s", strerror(errno));
  EXPECT(w.Look() - start >= wanted, "a sleep ended early");
}

void* Live(void* argument) {
  Worker& w = *static_cast<Worker*>(argument);
  Sleep(w);
  Enter(w);
  return argument;
}

void GiveBirth(Worker& w) {
  Worker born[kBorn];
  for (Worker& b : born) {
    b.seed = w.Draw(10'000);
    EXPECT(pthread_create(&b.thread, nullptr, Live, &b) == 0, "pthread_create");
  }
  for (Worker& b : born) {
    void* result = nullptr;
    EXPECT(pthread_join(b.thread, &result) == 0 && result == &b, "pthread_join");
    w.hash = w.hash * 31 + b.hash;
  }
}

void Fork(Worker& w) {
  const unsigned kind = w.Draw(3);
  const pid_t pid = fork();
  if (pid == 0) {
    if (kind == 0) execl("/bin/sleep", "sleep", "0.002", nullptr);
    if (kind == 1) usleep(1'500);
    _exit(kind == 0 ? 1 : 0);
  }
  int status = -1;
  pid_t ended;
  while ((ended = waitpid(pid, &status, 0)) < 0 && errno == EINTR) {
  }
  EXPECT(ended == pid && status == 0, "the child: %x, %s", status, strerror(errno));
}

void WaitForSemaphore(Worker& w) {
  const std::int64_t until = Now(CLOCK_REALTIME) + w.Draw(1'000'000);
  const timespec deadline = ToTimespec(until);
  int result;
  while ((result = sem_timedwait(&g_semaphore, &deadline)) != 0 && errno == EINTR) {
  }
  if (result != 0) EXPECT(Now(CLOCK_REALTIME) >= until, "sem_timedwait ended early");
}

Worker g_workers[kWorkers];

void* Work(void* argument) {
  Worker& w = *static_cast<Worker*>(argument);
  const std::int64_t end = w.Look() + g_run;
  while (w.Look() < end) {
    ++w.rounds;
    switch (w.Draw(16)) {
      case 0:
      case 1:
      case 2:
        Enter(w);
        break;
      case 3:
      case 4:
        EnterLending(w);
        break;
      case 5:
      case 6:
        Put();
        break;
      case 7:
      case 8:
        TakeUntil(w);
        break;
      case 9:
      case 10:
        Sleep(w);
        break;
      case 11:
        if (w.Draw(4) == 0) GiveBirth(w);
        break;
      case 12:
        if (w.Draw(8) == 0) Fork(w);
        break;
      case 13:
        sem_post(&g_semaphore);
        break;
      case 14:
        WaitForSemaphore(w);
        break;
      default:
        pthread_kill(g_workers[w.Draw(kWorkers)].thread, SIGUSR1);
    }
  }
  return nullptr;
}

// Answers every token: a wake-up that is lost stops it for good.
struct Rally {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t turned = PTHREAD_COND_INITIALIZER;
  int turn = 0;
  std::int64_t strokes = 0;
} g_rally;

void* Play(void* argument) {
  const int side = static_cast<int>(reinterpret_cast<std::intptr_t>(argument));
  for (;;) {
    pthread_mutex_lock(&g_rally.mutex);
    while (g_rally.turn != side && !g_done) pthread_cond_wait(&g_rally.turned, &g_rally.mutex);
    g_rally.turn = (side + 1) % 3;
    ++g_rally.strokes;
    pthread_cond_broadcast(&g_rally.turned);
    pthread_mutex_unlock(&g_rally.mutex);
    if (g_done) return nullptr;
    if (side == 0) usleep(50);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (argc > 2) g_run = atoi(argv[2]) * kMs;
  struct sigaction action {};
  action.sa_handler = OnSignal;
  sigaction(SIGUSR1, &action, nullptr);
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  pthread_mutex_init(&g_lending, &attributes);
  sem_init(&g_semaphore, 0, 0);
  pthread_t players[3];
  for (std::intptr_t side = 0; side < 3; ++side) {
    pthread_create(&players[side], nullptr, Play, reinterpret_cast<void*>(side));
  }
  unsigned seed = 1;
  for (Worker& w : g_workers) {
    w.seed = seed++;
    pthread_create(&w.thread, nullptr, Work, &w);
  }
  for (Worker& w : g_workers) EXPECT(pthread_join(w.thread, nullptr) == 0, "pthread_join");
  pthread_mutex_lock(&g_rally.mutex);
  g_done = true;
  pthread_cond_broadcast(&g_rally.turned);
  pthread_mutex_unlock(&g_rally.mutex);
  for (pthread_t player : players) pthread_join(player, nullptr);
  EXPECT(g_put == g_taken + g_queued, "put %lld, taken %lld, left %d", (long long)g_put,
         (long long)g_taken, g_queued);
  std::int64_t rounds = 0, hash = 0;
  for (const Worker& w : g_workers) rounds += w.rounds, hash = hash * 31 + w.hash;
  printf("%lld rounds, %lld and %lld entries, %lld strokes, %lld signals, clocks %llx\n",
         (long long)rounds, (long long)g_entries, (long long)g_lent_entries,
         (long long)g_rally.strokes, (long long)g_signals.load(), (unsigned long long)hash);
}
