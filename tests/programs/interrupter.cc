// Interrupts the calls in which the threads of a process wait, all but the first thread's, as it
// happens when a container is frozen for a moment: no handler runs, and the kernel makes the calls
// again.
#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

#include <string>

namespace {

bool Interrupt(pid_t tid) {
  if (ptrace(PTRACE_SEIZE, tid, nullptr, nullptr) != 0) return false;
  if (ptrace(PTRACE_INTERRUPT, tid, nullptr, nullptr) != 0) return false;
  for (;;) {
    int status = 0;
    if (waitpid(tid, &status, __WALL) != tid || !WIFSTOPPED(status)) return false;
    if (status >> 16 == PTRACE_EVENT_STOP) break;
    ptrace(PTRACE_CONT, tid, nullptr, WSTOPSIG(status));  // a signal, which goes on to it
  }
  return ptrace(PTRACE_DETACH, tid, nullptr, nullptr) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string threads = std::string("/proc/") + argv[1] + "/task";
  DIR* folder = opendir(threads.c_str());
  if (folder == nullptr) return 1;
  while (const dirent* entry = readdir(folder)) {
    const pid_t tid = atoi(entry->d_name);
    if (tid == 0 || tid == atoi(argv[1])) continue;
    if (!Interrupt(tid)) {
      perror("interrupter");
      return 1;
    }
  }
  closedir(folder);
}
