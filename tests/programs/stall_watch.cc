// Sees for how long the machine keeps threads waiting that want to run, one on each processor that
// it may use. Says "watching", and when it gets SIGTERM the longest wait, in µs.
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <thread>

namespace {

constexpr std::int64_t kEveryNs = 1'000'000, kSecond = 1'000'000'000;

std::atomic<std::int64_t> g_longest_ns{0};

std::int64_t Now() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kSecond + t.tv_nsec;
}

void Watch(int cpu) {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(cpu, &only);
  sched_setaffinity(0, sizeof only, &only);
  while (true) {
    const std::int64_t due = Now() + kEveryNs;
    const timespec until{due / kSecond, due % kSecond};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    g_longest_ns = std::max(g_longest_ns.load(), Now() - due);
  }
}

}  // namespace

int main() {
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &end, nullptr);
  cpu_set_t cpus;
  if (sched_getaffinity(0, sizeof cpus, &cpus) != 0) return 1;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &cpus)) std::thread(Watch, cpu).detach();
  }
  puts("watching");
  fflush(stdout);
  int signal;
  sigwait(&end, &signal);
  printf("%lld\n", static_cast<long long>(g_longest_ns / 1000));
  fflush(stdout);
  _Exit(0);
}
