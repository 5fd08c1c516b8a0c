// Threads that end without a word of their own: the first one by pthread_exit, others because one
// of them executes another program.
#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

void* Sleep(void*) {
  usleep(200'000);
  return nullptr;
}

void* ExecuteSleep(void*) {
  usleep(1'000);
  execlp("sleep", "sleep", "0.5", nullptr);
  return nullptr;
}

// The kernel clears it when the child's first thread has ended. It holds a state, as glibc has it
// from 2.43 on, and no thread's id.
constexpr std::uint32_t kJoinable = 2;
std::atomic<std::uint32_t> g_state{kJoinable};

pid_t WithState() {
  return static_cast<pid_t>(
      syscall(SYS_clone, SIGCHLD | CLONE_CHILD_CLEARTID, nullptr, nullptr, &g_state, nullptr));
}

void* AwaitState(void*) {
  while (g_state == kJoinable) {
    syscall(SYS_futex, &g_state, FUTEX_WAIT, kJoinable, nullptr, nullptr, 0);
  }
  _exit(0);
}

template <class Program>
void InAChild(const char* what, std::int64_t life_ns, Program program, pid_t (*make)() = fork) {
  const std::int64_t start = Now();
  const pid_t pid = make();
  if (pid == 0) {
    program();
    _exit(1);
  }
  int status = -1;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "%s: status %x", what, status);
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= life_ns, "%s took %lld ns", what, (long long)passed);
  // What a program's start costs is the host's; the others sleep for longer than it may take.
  const std::int64_t start_ns = g_mode == Mode::kMeasured ? 300 * kMs : 20 * kMs;
  if (g_mode != Mode::kNative) {
    EXPECT(passed < life_ns + start_ns, "%s took %lld ns", what, (long long)passed);
  }
}

pthread_t Begun(void* (*routine)(void*)) {
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, routine, nullptr) == 0, "pthread_create");
  return thread;
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  InAChild("the first thread's end", 200 * kMs, [] {
    Begun(Sleep);
    usleep(1'000);
    pthread_exit(nullptr);
  });
  InAChild("a program beside threads that sleep", 505 * kMs, [] {
    Begun(Sleep);
    usleep(5'000);
    execlp("sleep", "sleep", "0.5", nullptr);
  });
  InAChild("a program of another thread", 501 * kMs, [] {
    Begun(Sleep);
    pthread_join(Begun(ExecuteSleep), nullptr);
  });
  InAChild("a program of another thread, the first one gone", 501 * kMs, [] {
    Begun(ExecuteSleep);
    pthread_exit(nullptr);
  });
  InAChild(
      "a state that the kernel clears", 200 * kMs,
      [] {
        Begun(AwaitState);
        usleep(200'000);
        pthread_exit(nullptr);
      },
      WithState);
}
