// Children made by the system call, past the C library, that make no call but their end: their
// parent waits for them like for others.
#include <linux/sched.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

// Computes for a while, so that it lives when its parent waits, and ends without the C library.
[[noreturn]] void End(long code) {
  for (long i = 0; i < 20'000'000; ++i) __asm__ volatile("" : "+r"(i));
  for (;;) {
    long result;
    __asm__ volatile("syscall"
                     : "=a"(result)
                     : "a"(SYS_exit_group), "D"(code)
                     : "rcx", "r11", "memory");
  }
}

int Function(void*) { End(3); }

char g_stack[64 * 1024];

pid_t ByClone() { return clone(Function, g_stack + sizeof g_stack, SIGCHLD, nullptr); }

pid_t BySharing() { return clone(Function, g_stack + sizeof g_stack, SIGCHLD | CLONE_VM, nullptr); }

pid_t ByRawClone() {
  const long pid = syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr);
  if (pid == 0) End(3);
  return static_cast<pid_t>(pid);
}

pid_t ByClone3() {
  clone_args arguments{};
  arguments.exit_signal = SIGCHLD;
  const long pid = syscall(SYS_clone3, &arguments, sizeof arguments);
  if (pid == 0) End(3);
  if (pid < 0 && errno == ENOSYS) return ByRawClone();  // in containers
  return static_cast<pid_t>(pid);
}

pid_t ByRawFork() {
  const long pid = syscall(SYS_fork);
  if (pid == 0) End(3);
  return static_cast<pid_t>(pid);
}

pid_t ByVfork() {
  return clone(Function, g_stack + sizeof g_stack, SIGCHLD | CLONE_VM | CLONE_VFORK, nullptr);
}

using Wait = pid_t (*)(pid_t pid, int* status);

pid_t Waitpid(pid_t pid, int* status) { return waitpid(pid, status, 0); }
pid_t Any(pid_t, int* status) { return wait(status); }
pid_t Wait4(pid_t pid, int* status) {
  return static_cast<pid_t>(syscall(SYS_wait4, pid, status, 0, nullptr));
}

void Check(const char* what, pid_t (*make)()) {
  for (const Wait wait : {Waitpid, Any, Wait4}) {
    const pid_t pid = make();
    EXPECT(pid > 0, "%s: %s", what, strerror(errno));
    int status = 0;
    EXPECT(wait(pid, &status) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 3, "%s: %x, %s",
           what, status, strerror(errno));
  }
}

// One that is known, and lives for a while; natively until it may end.
pid_t ByFork(const std::atomic<bool>* may_end = nullptr) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  usleep(100'000);
  NativelyUntil([=] { return may_end == nullptr || may_end->load(); });
  _exit(4);
}

std::atomic<bool>* SharedFlag() {
  return static_cast<std::atomic<bool>*>(
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
}

// Beside one that is known.
void Beside() {
  std::atomic<bool>* const unknown_has_ended = SharedFlag();
  const std::int64_t start = Now();
  const pid_t known = ByFork(unknown_has_ended);
  const pid_t unknown = ByRawFork();
  int status = 0;
  EXPECT(wait(&status) == unknown && WEXITSTATUS(status) == 3, "%x", status);
  *unknown_has_ended = true;
  EXPECT(wait(&status) == known && WEXITSTATUS(status) == 4, "%x", status);
  EXPECT(Now() - start >= 100 * kMs, "early");
  EXPECT(wait(&status) == -1 && errno == ECHILD, "one more");
}

// Beside one that only a wait for all kinds of children finds.
void BesideOneWithoutASignal() {
  const std::int64_t start = Now();
  const pid_t known = ByFork();
  clone_args arguments{};
  long quiet = syscall(SYS_clone3, &arguments, sizeof arguments);
  if (quiet < 0 && errno == ENOSYS)
    quiet = syscall(SYS_clone, 0, nullptr, nullptr, nullptr, nullptr);
  if (quiet == 0) End(3);
  int status = 0;
  EXPECT(wait(&status) == known && WEXITSTATUS(status) == 4, "%x", status);
  const std::int64_t took = Now() - start;
  EXPECT(took >= 100 * kMs, "%lld ns", (long long)took);
  if (g_mode != Mode::kNative) EXPECT(took < 200 * kMs, "%lld ns", (long long)took);
  EXPECT(wait(&status) == -1 && errno == ECHILD, "one more");
  EXPECT(waitpid(-1, &status, __WALL) == quiet && WEXITSTATUS(status) == 3, "%x", status);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Check("clone", ByClone);
  Check("clone with one memory", BySharing);
  Check("clone made raw", ByRawClone);
  Check("clone3", ByClone3);
  Check("fork made raw", ByRawFork);
  Check("clone as vfork", ByVfork);
  Beside();
  BesideOneWithoutASignal();
}
