// Threads made by the system call without CLONE_SETTLS: they find their maker's thread-local
// storage as theirs, and wait on their own all the same.
//
// They make nothing but system calls by syscall(), and none that fails: errno is their maker's,
// too.
#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>

#include "tests/conformance/conformance.h"

namespace {

using namespace conformance;

constexpr int kThreads = 3;
constexpr std::size_t kStackSize = 64 * 1024;

struct Thread {
  alignas(16) char stack[kStackSize];
  std::atomic<int> ended_word;  // the kernel clears it, and wakes who waits for that
  int pipe[2];
  std::int64_t naps_ns;
  std::int64_t begun, woken;
};

Thread g_threads[kThreads];

// Raw, so that it goes through no library that the maker may be in.
std::int64_t Clock() {
  timespec now;
  syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
  return ToNs(now);
}

int Run(void* argument) {
  Thread& thread = *static_cast<Thread*>(argument);
  thread.begun = Clock();
  for (int i = 0; i < 10; ++i) {
    const timespec nap = ToTimespec(thread.naps_ns);
    syscall(SYS_nanosleep, &nap, nullptr);
  }
  thread.woken = Clock();
  syscall(SYS_write, thread.pipe[1], "x", 1);
  syscall(SYS_exit, 0);
  return 0;
}

void Start(Thread& thread, std::int64_t naps_ns) {
  thread.naps_ns = naps_ns;
  thread.ended_word = 1;
  EXPECT(pipe(thread.pipe) == 0, "pipe");
  constexpr int kFlags = CLONE_VM | CLONE_FS | CLONE_FILES | CLONE_SIGHAND | CLONE_THREAD |
                         CLONE_SYSVSEM | CLONE_CHILD_CLEARTID;
  const int tid =
      clone(Run, thread.stack + kStackSize, kFlags, &thread, nullptr, nullptr, &thread.ended_word);
  EXPECT(tid > 0, "clone: %s", strerror(errno));
}

// Each naps ten times while its maker naps, reads what one of them writes, and waits for all ends.
void NapBesideTheirMaker() {
  const std::int64_t start = Now();
  for (int i = 0; i < kThreads; ++i) Start(g_threads[i], (i + 1) * 5 * kMs);
  for (int i = 0; i < 7; ++i) usleep(2'000);
  ExpectSoonAfter(start, 14 * kMs, "the maker's naps");
  char byte = 0;
  EXPECT(read(g_threads[1].pipe[0], &byte, 1) == 1 && byte == 'x', "read: %s", strerror(errno));
  ExpectSoonAfter(start, 100 * kMs, "a read of what the second writes");
  for (int i = 0; i < kThreads; ++i) {
    Thread& thread = g_threads[i];
    while (thread.ended_word.load() != 0) {
      syscall(SYS_futex, &thread.ended_word, FUTEX_WAIT, 1, nullptr, nullptr, 0);
    }
    ExpectSoonAfter(start, std::max(100, (i + 1) * 50) * kMs, "the end of one");
    const std::int64_t slept = thread.woken - thread.begun;
    EXPECT(slept >= 10 * thread.naps_ns, "%d slept %lld ns", i, (long long)slept);
    if (g_mode != Mode::kNative) {
      // Ten times a trapped call, and the others before it.
      EXPECT(slept < 10 * thread.naps_ns + (g_mode == Mode::kFixed ? 1 : 10) * kMs,
             "%d slept %lld ns", i, (long long)slept);
    }
    close(thread.pipe[0]);
    close(thread.pipe[1]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int i = 0; i < 5; ++i) NapBesideTheirMaker();
  // The maker is what it was.
  const pid_t child = fork();
  if (child == 0) {
    usleep(1'000);
    _exit(3);
  }
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && WEXITSTATUS(status) == 3, "%x", status);
}
