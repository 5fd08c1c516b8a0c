// Periodic threads as in textbooks of real-time analysis. Each is
//   PRIORITY PHASE_US PERIOD_US JOBS WORK
// and "--" stands between them; the first is the main thread. Priority 0 leaves what the thread
// has, others are of SCHED_FIFO. The first job is released PHASE_US after 0.1 s of the robot's
// time. WORK is a word such as "500l1000u500": computes for 500 us, locks the mutex, computes for
// 1000 us, unlocks it, computes for 500 us. With "pi" before all that the mutex lends priority.
// Exit status 3: SCHED_FIFO is not permitted.
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <vector>

namespace {

constexpr std::int64_t kFirstReleaseNs = 1'000'100'000'000;  // robots start at 1000 s

struct Task {
  int priority = 0;
  std::int64_t phase_ns = 0, period_ns = 0;
  int jobs = 0;
  const char* work = "";
};

pthread_mutex_t g_mutex;

void ComputeFor(std::int64_t ns) {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  const std::int64_t end = t.tv_sec * 1'000'000'000 + t.tv_nsec + ns;
  do {
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  } while (t.tv_sec * 1'000'000'000 + t.tv_nsec < end);
}

void DoWork(const char* work) {
  while (*work != 0) {
    if (*work == 'l') {
      pthread_mutex_lock(&g_mutex);
      ++work;
    } else if (*work == 'u') {
      pthread_mutex_unlock(&g_mutex);
      ++work;
    } else {
      char* end = nullptr;
      ComputeFor(strtol(work, &end, 10) * 1000);
      work = end;
    }
  }
}

void* Run(void* raw) {
  const Task& task = *static_cast<const Task*>(raw);
  if (task.priority > 0) {
    const sched_param param{task.priority};
    if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) != 0) exit(3);
  }
  std::int64_t release_ns = kFirstReleaseNs + task.phase_ns;
  for (int job = 0; job < task.jobs; ++job) {
    const timespec at{release_ns / 1'000'000'000, release_ns % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
    DoWork(task.work);
    release_ns += task.period_ns;
  }
  pause();
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  int at = 1;
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  if (argc > 1 && strcmp(argv[1], "pi") == 0) {
    pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
    ++at;
  }
  pthread_mutex_init(&g_mutex, &attributes);
  std::vector<Task> tasks;
  for (; at + 4 < argc; at += 6) {
    tasks.push_back({atoi(argv[at]), atoll(argv[at + 1]) * 1000, atoll(argv[at + 2]) * 1000,
                     atoi(argv[at + 3]), argv[at + 4]});
  }
  if (tasks.empty()) return 2;
  for (std::size_t i = 1; i < tasks.size(); ++i) {
    pthread_t thread;
    if (pthread_create(&thread, nullptr, Run, &tasks[i]) != 0) return 1;
  }
  Run(&tasks[0]);
}
