// What runs beside a hostile program: it does what ordinary ones do, and says when.
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>

namespace {

long long Now() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

pthread_mutex_t g_mutex = PTHREAD_MUTEX_INITIALIZER;
pthread_cond_t g_changed = PTHREAD_COND_INITIALIZER;
long g_turn = 0;

void* TakeTurns(void*) {
  for (;;) {
    pthread_mutex_lock(&g_mutex);
    while (g_turn % 2 == 0) pthread_cond_wait(&g_changed, &g_mutex);
    ++g_turn;
    pthread_cond_signal(&g_changed);
    pthread_mutex_unlock(&g_mutex);
  }
}

}  // namespace

int main() {
  pthread_t thread;
  pthread_create(&thread, nullptr, TakeTurns, nullptr);
  const int timer = timerfd_create(CLOCK_MONOTONIC, 0);
  const itimerspec each{{0, 1'000'000}, {0, 1'000'000}};
  timerfd_settime(timer, 0, &each, nullptr);
  int ends[2];
  if (pipe(ends) != 0) return 1;
  for (int i = 0; i < 90; ++i) {
    std::uint64_t count = 0;
    if (read(timer, &count, sizeof count) != sizeof count) return 1;
    pthread_mutex_lock(&g_mutex);
    ++g_turn;
    pthread_cond_signal(&g_changed);
    while (g_turn % 2 == 1) pthread_cond_wait(&g_changed, &g_mutex);
    pthread_mutex_unlock(&g_mutex);
    char byte = 'x';
    if (write(ends[1], &byte, 1) != 1 || read(ends[0], &byte, 1) != 1) return 1;
    printf("%d %llu %lld\n", i, static_cast<unsigned long long>(count), Now());
    if (i % 30 == 29) {
      fflush(stdout);
      const pid_t child = fork();
      if (child == 0) {
        usleep(500);
        _exit(7);
      }
      int status = 0;
      waitpid(child, &status, 0);
      printf("%d %lld\n", status, Now());
    }
  }
  puts("done");
}
