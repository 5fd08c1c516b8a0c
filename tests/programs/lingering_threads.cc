// lingering_threads: thousands of threads that end, while somebody sends them signals: a handler
// that runs in a thread that is just ending computes on for ever. So do the first few hundred: how
// many are hit depends on the host, and each that computes on makes the rest take longer.
// lingering_threads PID: sends those signals, to all threads of the process, until it has ended.
#include <dirent.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <string>

namespace {

constexpr int kThreads = 3'000, kMostLingering = 300;

thread_local volatile bool g_is_leaving = false;
std::atomic<int> g_lingering{0};

void Linger(int) {
  if (g_is_leaving && g_lingering.fetch_add(1) >= kMostLingering) return;
  while (g_is_leaving) {
  }
}

void* Leave(void*) {
  g_is_leaving = true;
  syscall(SYS_exit, 0);
  return nullptr;
}

int Pester(pid_t pid) {
  const std::string folder = "/proc/" + std::to_string(pid) + "/task";
  while (DIR* threads = opendir(folder.c_str())) {
    while (const dirent* entry = readdir(threads)) {
      const int tid = atoi(entry->d_name);
      if (tid > 0 && tid != pid) syscall(SYS_tgkill, pid, tid, SIGUSR1);
    }
    closedir(threads);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) return Pester(atoi(argv[1]));
  signal(SIGUSR1, Linger);
  pthread_attr_t small;
  pthread_attr_init(&small);
  pthread_attr_setstacksize(&small, 64 << 10);
  pthread_attr_setdetachstate(&small, PTHREAD_CREATE_DETACHED);
  for (int i = 0; i < kThreads; ++i) {
    pthread_t thread;
    if (pthread_create(&thread, &small, Leave, nullptr) != 0) return 2;
    const timespec pause{0, 100'000};
    nanosleep(&pause, nullptr);
  }
  printf("%d threads lingered\n", std::min(g_lingering.load(), kMostLingering));
  return 0;
}
