// Threads and processes that the shim has not made: by the C library's own pthread_create, found
// through a handle (as ctypes, RTLD_DEEPBIND and runtimes find it), by the C library for itself,
// and by the system calls. They are there from their births on: what they do takes its time, and
// who waits for them waits for that.
#include <aio.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <linux/sched.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>
#include <vector>

#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

using Create = int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
using Join = int(pthread_t, void**);

void* const g_libc = dlopen("libc.so.6", RTLD_NOW);
const auto g_create = reinterpret_cast<Create*>(dlsym(g_libc, "pthread_create"));
const auto g_join = reinterpret_cast<Join*>(dlsym(g_libc, "pthread_join"));

pthread_mutex_t g_mutex = PTHREAD_MUTEX_INITIALIZER;
pthread_cond_t g_condition = PTHREAD_COND_INITIALIZER;
int g_pipe[2];

// Past the C library, too.
void SleepRaw(std::int64_t ns) {
  timespec time = ToTimespec(ns);
  long result;
  __asm__ volatile("syscall"
                   : "=a"(result)
                   : "a"(SYS_nanosleep), "D"(&time), "S"(nullptr)
                   : "rcx", "r11", "memory");
}

void Compute() {
  for (long i = 0; i < 20'000'000; ++i) __asm__ volatile("" : "+r"(i));
}

// What a thread does, and how much later than its creation it ends. Its creator sleeps for 200 ms,
// lets go of what it holds, and joins it.
struct Deed {
  const char* name;
  void* (*what)(void*);
  std::int64_t ends_ns;
};

const Deed kDeeds[] = {
    {"nothing", [](void*) -> void* { return nullptr; }, 200 * kMs},
    {"a sleep",
     [](void*) -> void* {
       usleep(500'000);
       return nullptr;
     },
     500 * kMs},
    {"a sleep by the system call",
     [](void*) -> void* {
       SleepRaw(500 * kMs);
       return nullptr;
     },
     500 * kMs},
    {"a lock",
     [](void*) -> void* {
       pthread_mutex_lock(&g_mutex);
       pthread_mutex_unlock(&g_mutex);
       return nullptr;
     },
     200 * kMs},
    {"a condition",
     [](void*) -> void* {
       pthread_mutex_lock(&g_mutex);
       timespec until = ToTimespec(Now(CLOCK_REALTIME) + kSecond);
       pthread_cond_timedwait(&g_condition, &g_mutex, &until);
       pthread_mutex_unlock(&g_mutex);
       return nullptr;
     },
     1200 * kMs},
    {"a read",
     [](void*) -> void* {
       char byte;
       EXPECT(read(g_pipe[0], &byte, 1) == 1, "%s", strerror(errno));
       return nullptr;
     },
     200 * kMs},
    {"computing",
     [](void*) -> void* {
       Compute();
       return nullptr;
     },
     200 * kMs},
};

// Computes before its first call, and tells what it was charged.
void* WhatItComputed(void* charged) {
  Compute();
  *static_cast<std::int64_t*>(charged) = Now(CLOCK_THREAD_CPUTIME_ID);
  return nullptr;
}

struct Case {
  const Deed* deed;
  Join* join;
};

void Check(const Case& one) {
  const Deed& deed = *one.deed;
  EXPECT(pipe(g_pipe) == 0, "%s", strerror(errno));
  pthread_mutex_lock(&g_mutex);
  const std::int64_t start = Now();
  pthread_t thread;
  EXPECT(g_create(&thread, nullptr, deed.what, nullptr) == 0, "%s", deed.name);
  usleep(200'000);
  pthread_mutex_unlock(&g_mutex);
  EXPECT(write(g_pipe[1], "x", 1) == 1, "write");
  EXPECT(one.join(thread, nullptr) == 0, "join after %s", deed.name);
  ExpectPassed(start, deed.ends_ns, deed.name);
  close(g_pipe[0]);
  close(g_pipe[1]);
}

void Threads() {
  EXPECT(g_create != nullptr && g_join != nullptr, "no C library");
  std::vector<Case> cases;
  for (Join* join : {g_join, &pthread_join}) {
    for (const Deed& deed : kDeeds) cases.push_back({&deed, join});
  }
  ForEachAtOnceNatively(cases, Check);
  std::int64_t charged = -1;
  pthread_t thread;
  const std::int64_t start = Now();
  EXPECT(g_create(&thread, nullptr, WhatItComputed, &charged) == 0, "create");
  EXPECT(pthread_join(thread, nullptr) == 0, "join");
  const std::int64_t passed = Now() - start;
  EXPECT(charged >= 0, "nobody has run");
  if (g_mode != Mode::kMeasured) return;
  EXPECT(charged >= 3 * kMs && charged <= passed, "%lld of %lld ns", (long long)charged,
         (long long)passed);
}

// A runtime's helper, with all signals blocked, which sleeps again and again beside others.
void* SleepForEver(void*) {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  for (;;) SleepRaw(7 * kMs);
}

void* SleepFiftyTimes(void*) {
  for (int i = 0; i < 50; ++i) usleep(1'000);
  return nullptr;
}

void Helpers() {
  pthread_t helper, others[3];
  EXPECT(g_create(&helper, nullptr, SleepForEver, nullptr) == 0, "create");
  const std::int64_t start = Now();
  for (pthread_t& other : others) pthread_create(&other, nullptr, SleepFiftyTimes, nullptr);
  for (const pthread_t other : others) pthread_join(other, nullptr);
  usleep(1'000'000);
  ExpectSoonAfter(start, 1050 * kMs, "sleeps beside a helper");
}

// Asynchronous I/O, which a thread of the C library's does, and a look every 10 ms.
void Looks() {
  char text[64];
  aiocb request{};
  request.aio_fildes = open("/etc/passwd", O_RDONLY | O_CLOEXEC);
  request.aio_buf = text;
  request.aio_nbytes = sizeof text;
  EXPECT(aio_read(&request) == 0, "%s", strerror(errno));
  int looks = 0;
  for (; aio_error(&request) == EINPROGRESS; ++looks) usleep(10'000);
  EXPECT(aio_error(&request) == 0 && aio_return(&request) == sizeof text, "aio_read");
  if (g_mode != Mode::kNative) EXPECT(looks <= 1, "%d looks", looks);
  close(request.aio_fildes);
}

struct Shared {
  std::atomic<std::uint32_t> word;
};

Shared* Share() {
  void* memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  EXPECT(memory != MAP_FAILED, "%s", strerror(errno));
  return new (memory) Shared{};
}

pid_t ByClone3(std::uint64_t flags, int* pidfd) {
  clone_args arguments{};
  arguments.flags = flags;
  arguments.pidfd = reinterpret_cast<std::uintptr_t>(pidfd);
  arguments.exit_signal = SIGCHLD;
  const long pid = syscall(SYS_clone3, &arguments, sizeof arguments);
  if (pid >= 0 || errno != ENOSYS) return static_cast<pid_t>(pid);
  return static_cast<pid_t>(  // in containers
      syscall(SYS_clone, flags | SIGCHLD, nullptr, pidfd, nullptr, nullptr));
}

void ExpectEnd(pid_t pid, int code, const char* what) {
  int status = -1;
  EXPECT(waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == code,
         "%s: status %x, %s", what, static_cast<unsigned>(status), strerror(errno));
}

// Its parent waits for it with a deadline that is far away.
void ChildrenThatWake() {
  Shared* shared = Share();
  const std::int64_t start = Now();
  const pid_t pid = ByClone3(0, nullptr);
  EXPECT(pid >= 0, "%s", strerror(errno));
  if (pid == 0) {
    usleep(10'000);
    NativelyUntil([] { return Sleeps(getppid()); });
    shared->word = 1;
    syscall(SYS_futex, &shared->word, FUTEX_WAKE, 1, nullptr, nullptr, 0);
    SleepRaw(10 * kMs);
    _exit(7);
  }
  const timespec most{5, 0};
  EXPECT(syscall(SYS_futex, &shared->word, FUTEX_WAIT, 0, &most, nullptr, 0) == 0, "%s",
         strerror(errno));
  ExpectPassed(start, 10 * kMs, "a child that wakes", MostOfChildren());
  ExpectEnd(pid, 7, "a child that wakes");
  ExpectPassed(start, 20 * kMs, "its end", MostOfChildren());
}

void ChildrenWithDescriptors() {
  int pidfd = -1;
  const std::int64_t start = Now();
  const pid_t pid = ByClone3(CLONE_PIDFD, &pidfd);
  EXPECT(pid >= 0, "%s", strerror(errno));
  if (pid == 0) {
    if (g_mode != Mode::kNative && Now() - start > MostOfChildren() / 2) _exit(1);
    usleep(300'000);
    _exit(2);
  }
  pollfd end{pidfd, POLLIN, 0};
  EXPECT(poll(&end, 1, 30'000) == 1, "no end");
  ExpectPassed(start, 300 * kMs, "a pidfd", MostOfChildren());
  ExpectEnd(pid, 2, "a pidfd");
  close(pidfd);
}

char g_stack[64 * 1024];

int SleepAndEnd(void*) {
  SleepRaw(300 * kMs);
  return 3;
}

void* SleepInThread(void*) {
  SleepRaw(300 * kMs);
  return nullptr;
}

int EndWithThread(void*) {
  pthread_t thread;
  pthread_create(&thread, nullptr, SleepInThread, nullptr);
  return pthread_join(thread, nullptr) == 0 ? 3 : 1;
}

int Execute(void*) {
  execl("/bin/sleep", "sleep", "0.3", nullptr);
  return 1;
}

void OfAllKinds() {
  constexpr struct {
    const char* name;
    int (*what)(void*);
    int flags, code;
    bool waits;  // the parent, for its child, until that executes or ends
  } kKinds[] = {
      {"a clone", SleepAndEnd, 0, 3, false},
      {"a clone with a thread", EndWithThread, 0, 3, false},
      {"a vfork with memory of its own", SleepAndEnd, CLONE_VFORK, 3, true},
      {"a vfork", SleepAndEnd, CLONE_VFORK | CLONE_VM, 3, true},
      {"a clone that executes", Execute, 0, 0, false},
      {"a vfork with memory of its own that executes", Execute, CLONE_VFORK, 0, false},
      {"a vfork that executes", Execute, CLONE_VFORK | CLONE_VM, 0, false},
  };
  ForEachAtOnceNatively(kKinds, [](const auto& kind) {
    const std::int64_t start = Now();
    const pid_t pid = clone(kind.what, g_stack + sizeof g_stack, kind.flags | SIGCHLD, nullptr);
    EXPECT(pid > 0, "%s: %s", kind.name, strerror(errno));
    const std::int64_t back = Now() - start;
    if (kind.waits) EXPECT(back >= 300 * kMs, "%s: back after %lld ns", kind.name, (long long)back);
    if (!kind.waits && g_mode != Mode::kNative) EXPECT(back < 100 * kMs, "%s: waited", kind.name);
    ExpectEnd(pid, kind.code, kind.name);
    // What a program's start costs is the host's, too.
    ExpectSoonAfter(start, 300 * kMs, kind.name, (g_mode == Mode::kMeasured ? 200 : 40) * kMs);
  });
}

// Whose parent has ended before it does anything.
void Orphans() {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  const std::int64_t start = Now();
  const pid_t pid = ByClone3(0, nullptr);
  if (pid == 0) {
    if (ByClone3(0, nullptr) != 0) _exit(1);
    SleepRaw(300 * kMs);
    _exit(write(ends[1], "x", 1) == 1 ? 0 : 1);
  }
  close(ends[1]);
  char byte = 0;
  EXPECT(read(ends[0], &byte, 1) == 1 && byte == 'x', "nothing came");
  ExpectSoonAfter(start, 300 * kMs, "an orphan");
  ExpectEnd(pid, 1, "an orphan's parent");
  close(ends[0]);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Threads();
  Helpers();
  Looks();
  ChildrenThatWake();
  ChildrenWithDescriptors();
  OfAllKinds();
  Orphans();
  _exit(0);  // the helper sleeps on
}
