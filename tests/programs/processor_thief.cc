// Takes the processor that a program is bound to away from it, again and again.
//
//   processor_thief computing PID [TIMES]   by computing above everybody, for 30 ms each time: the
//                                           kernel charges that to the thief
//   processor_thief interrupts PID [TIMES]  by the interrupt in which very many timers run out at
//                                           once: the kernel charges that to the program which it
//                                           hits, as it does with what a hypervisor takes and does
//                                           not tell
//
// It ends when the program has ended, and after 15 s at the latest; or after so many times, when it
// sends SIGTERM to the program. It says how long each took. Ends with 77 where it may not.
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

constexpr std::size_t kTimers = 100'000;
constexpr int kForEver = 1'000'000;
constexpr std::int64_t kMs = 1'000'000, kSecond = 1'000'000'000;
constexpr std::int64_t kMostNs = 15 * kSecond, kEveryNs = 300 * kMs, kTakesNs = 30 * kMs,
                       kSettingTakesNs = 150 * kMs;

std::int64_t Now() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kSecond + t.tv_nsec;
}

timespec At(std::int64_t ns) { return {ns / kSecond, ns % kSecond}; }

void SleepUntil(std::int64_t ns) {
  const timespec until = At(ns);
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

void SayHowLong(std::int64_t since) {
  printf("%.1f ms ", static_cast<double>(Now() - since) / kMs);
}

// Above everybody on the processor of `pid`.
bool GoThere(pid_t pid) {
  cpu_set_t cpus;
  const sched_param level{99};
  return sched_getaffinity(pid, sizeof cpus, &cpus) == 0 && CPU_COUNT(&cpus) == 1 &&
         sched_setaffinity(0, sizeof cpus, &cpus) == 0 &&
         sched_setscheduler(0, SCHED_FIFO, &level) == 0;
}

// As many as one process may have.
std::vector<int> MakeTimers() {
  rlimit room{};
  getrlimit(RLIMIT_NOFILE, &room);
  room.rlim_cur = room.rlim_max;
  setrlimit(RLIMIT_NOFILE, &room);
  std::vector<int> timers;
  while (timers.size() < kTimers) {
    timers.push_back(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK));
    if (timers.back() >= 0) continue;
    timers.pop_back();
    break;
  }
  return timers;
}

// The rest has a child of this one, and so on. All run out at the same instants. True of the first
// of them, which alone says how long it took.
bool TakeByInterrupts(pid_t pid, std::int64_t start, int times, std::size_t missing) {
  const bool is_first = missing == kTimers;
  std::vector<int> timers = MakeTimers();
  timers.resize(std::min(timers.size(), missing));
  missing -= timers.size();
  if (timers.empty() || !GoThere(pid)) exit(77);
  const pid_t child = missing == 0 ? 0 : fork();
  if (child == 0 && missing > 0) {
    for (const int timer : timers) close(timer);
    return TakeByInterrupts(pid, start, times, missing);
  }
  std::int64_t next = start;
  for (; times > 0 && next < start + kMostNs && kill(pid, 0) == 0; next += kEveryNs) {
    if (next < Now() + kSettingTakesNs) continue;
    const itimerspec when{{0, 0}, At(next)};
    for (const int timer : timers) timerfd_settime(timer, TFD_TIMER_ABSTIME, &when, nullptr);
    SleepUntil(next);
    if (is_first) SayHowLong(next);
    --times;
  }
  if (child > 0) waitpid(child, nullptr, 0);
  return is_first;
}

bool TakeByComputing(pid_t pid, std::int64_t start, int times) {
  if (!GoThere(pid)) exit(77);
  std::int64_t next = start;
  for (; times > 0 && next < start + kMostNs && kill(pid, 0) == 0; next += kEveryNs) {
    SleepUntil(next);
    while (Now() < next + kTakesNs) {
    }
    SayHowLong(next);
    --times;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) return 2;
  const pid_t pid = atoi(argv[2]);
  const bool ends_it = argc == 4;
  const int times = ends_it ? atoi(argv[3]) : kForEver;
  const std::int64_t start = Now() + kEveryNs;
  const bool is_first = strcmp(argv[1], "interrupts") == 0
                            ? TakeByInterrupts(pid, start, times, kTimers)
                            : TakeByComputing(pid, start, times);
  if (!is_first) return 0;
  puts("taken");
  if (ends_it) kill(pid, SIGTERM);
  return 0;
}
