// dying_threads CHILDREN: so many children one after the other, each of which ends as a whole while
// its threads compute and sleep, and is reaped.
// dying_threads watch SECONDS: looks into /proc all the time, as `top` does, at the threads of all
// processes that are younger than itself.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>

namespace {

constexpr int kStatus = 7;

[[noreturn]] void EndAmongThreads() {
  for (int i = 0; i < 2; ++i) {
    std::thread([] {
      for (;;) __asm__ volatile("" : : : "memory");
    }).detach();
    std::thread([] {
      for (;;) std::this_thread::sleep_for(std::chrono::microseconds(300));
    }).detach();
  }
  std::this_thread::sleep_for(std::chrono::microseconds(500));
  _exit(kStatus);
}

void Watch(std::chrono::seconds time) {
  namespace fs = std::filesystem;
  const auto until = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < until) {
    std::error_code gone;
    for (fs::directory_iterator process("/proc", gone);
         !gone && process != fs::directory_iterator{}; process.increment(gone)) {
      if (atoi(process->path().filename().c_str()) <= getpid()) continue;
      std::error_code ended;
      for (fs::directory_iterator thread(process->path() / "task", ended);
           !ended && thread != fs::directory_iterator{}; thread.increment(ended)) {
        std::string text;
        std::getline(std::ifstream(thread->path() / "stat"), text);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "watch") {
    Watch(std::chrono::seconds(atoi(argv[2])));
    return 0;
  }
  const int children = argc > 1 ? atoi(argv[1]) : 1;
  for (int i = 0; i < children; ++i) {
    const pid_t child = fork();
    if (child == 0) EndAmongThreads();
    int status = 0;
    if (waitpid(child, &status, 0) != child || !WIFEXITED(status) ||
        WEXITSTATUS(status) != kStatus) {
      fprintf(stderr, "child %d of %d ended with %d (of waitpid)\n", i + 1, children, status);
      return 1;
    }
  }
  puts("all reaped");
  return 0;
}
