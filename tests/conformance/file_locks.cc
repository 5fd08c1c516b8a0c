// Locks of files (flock, fcntl's of both kinds, lockf): who waits has the lock when it is given up,
// by a call, by closing the file or by ending, and those who wait are served in their order.
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <new>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

char g_path[32];

// A file that nobody else locks.
void MakeFile() {
  strcpy(g_path, "/tmp/tcs_locks_XXXXXX");
  const int made = mkstemp(g_path);
  EXPECT(made >= 0, "mkstemp");
  close(made);
}

// What orders processes natively: where each has told that it comes to its wait.
conformance::InOrder& NewOrder() {
  void* memory = mmap(nullptr, sizeof(conformance::InOrder), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  EXPECT(memory != MAP_FAILED, "mmap");
  return *new (memory) conformance::InOrder;
}

void SleepUntil(std::int64_t until) {
  const timespec t = ToTimespec(until);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

struct flock Record(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_len = 10;
  return lock;
}

int Fcntl(int fd, int command, short type) {
  struct flock lock = Record(type);
  return fcntl(fd, command, &lock);
}

// One kind of lock: takes it, waiting or not, and gives it up.
struct Kind {
  const char* name;
  int (*lock)(int fd);
  int (*try_it)(int fd);
  int (*unlock)(int fd);
  bool ends_at_close = true;
};

const Kind kKinds[] = {
    {"flock", [](int fd) { return flock(fd, LOCK_EX); },
     [](int fd) { return flock(fd, LOCK_EX | LOCK_NB); },
     [](int fd) { return flock(fd, LOCK_UN); }},
    {"fcntl", [](int fd) { return Fcntl(fd, F_SETLKW, F_WRLCK); },
     [](int fd) { return Fcntl(fd, F_SETLK, F_WRLCK); },
     [](int fd) { return Fcntl(fd, F_SETLK, F_UNLCK); }},
    {"fcntl of open files", [](int fd) { return Fcntl(fd, F_OFD_SETLKW, F_WRLCK); },
     [](int fd) { return Fcntl(fd, F_OFD_SETLK, F_WRLCK); },
     [](int fd) { return Fcntl(fd, F_OFD_SETLK, F_UNLCK); }},
    {"lockf", [](int fd) { return lockf(fd, F_LOCK, 10); },
     [](int fd) { return lockf(fd, F_TLOCK, 10); }, [](int fd) { return lockf(fd, F_ULOCK, 10); }},
    {"raw flock", [](int fd) { return static_cast<int>(syscall(SYS_flock, fd, LOCK_EX)); },
     [](int fd) { return static_cast<int>(syscall(SYS_flock, fd, LOCK_EX | LOCK_NB)); },
     [](int fd) { return static_cast<int>(syscall(SYS_flock, fd, LOCK_UN)); }},
};

int Open() {
  const int fd = open(g_path, O_RDWR | O_CLOEXEC);
  EXPECT(fd >= 0, "open: %s", strerror(errno));
  return fd;
}

enum class Ends { kByCall, kByClose, kByExit };

// A child has the lock for 100 ms; the parent waits for it from 50 ms on, and computes on.
void BetweenProcesses(const Kind& kind, Ends ends) {
  InOrder& order = NewOrder();
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    const int fd = Open();
    EXPECT(kind.lock(fd) == 0, "%s: %s", kind.name, strerror(errno));
    order.Comes(0);
    SleepUntil(start + 100 * kMs);
    order.AwaitAll(2);
    if (ends == Ends::kByCall) EXPECT(kind.unlock(fd) == 0, "%s", kind.name);
    if (ends == Ends::kByClose) EXPECT(close(fd) == 0, "%s", kind.name);
    if (ends != Ends::kByExit) SleepUntil(start + 200 * kMs);
    _exit(0);
  }
  const int fd = Open();
  SleepUntil(start + 50 * kMs);
  NativelyUntil([&] { return order.tids[0] != 0; });
  EXPECT(kind.try_it(fd) == -1 && (errno == EAGAIN || errno == EACCES), "%s: not held", kind.name);
  if (g_mode == Mode::kNative) order.tids[1] = gettid();
  EXPECT(kind.lock(fd) == 0, "%s: %s", kind.name, strerror(errno));
  ExpectPassed(start, 100 * kMs, kind.name);
  EXPECT(kind.unlock(fd) == 0, "%s", kind.name);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %x", status);
  close(fd);
}

// Three wait one after another, each has it for 20 ms.
void ServedInOrder(const Kind& kind) {
  const int fd = Open();
  EXPECT(kind.lock(fd) == 0, "%s", kind.name);
  InOrder& order = NewOrder();
  const std::int64_t start = Now();
  pid_t children[3];
  for (int i = 0; i < 3; ++i) {
    children[i] = fork();
    if (children[i] != 0) continue;
    close(fd);
    const int own = Open();
    SleepUntil(start + (i + 1) * 25 * kMs);  // further apart than what a child's start may cost
    order.Comes(i);
    EXPECT(kind.lock(own) == 0, "%s", kind.name);
    ExpectPassed(start, (100 + i * 20) * kMs, kind.name);
    SleepUntil(start + (120 + i * 20) * kMs);
    EXPECT(kind.unlock(own) == 0, "%s", kind.name);
    _exit(0);
  }
  SleepUntil(start + 100 * kMs);
  order.AwaitAll(3);
  EXPECT(kind.unlock(fd) == 0, "%s", kind.name);
  for (const pid_t child : children) {
    int status = 0;
    EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %x", status);
  }
  close(fd);
}

// A handler ends the wait.
void Interrupted(const Kind& kind) {
  struct sigaction action {};
  action.sa_handler = [](int) {};
  sigaction(SIGUSR1, &action, nullptr);
  const pid_t parent = getpid();
  const std::int64_t start = Now();
  int ready[2], release[2];
  EXPECT(pipe(ready) == 0 && pipe(release) == 0, "pipe");
  char byte;
  const pid_t child = fork();
  if (child == 0) {
    const int fd = Open();
    EXPECT(kind.lock(fd) == 0 && write(ready[1], "x", 1) == 1, "%s", kind.name);
    SleepUntil(start + 60 * kMs);
    // On a loaded host the parent may not have come to its wait yet.
    pollfd released{release[0], POLLIN, 0};
    do {
      kill(parent, SIGUSR1);
    } while (poll(&released, 1, 50) == 0);
    _exit(0);
  }
  const int fd = Open();
  EXPECT(read(ready[0], &byte, 1) == 1, "read");
  EXPECT(kind.lock(fd) == -1 && errno == EINTR, "%s: %s", kind.name, strerror(errno));
  ExpectPassed(start, 60 * kMs, "a handler");
  EXPECT(write(release[1], "x", 1) == 1, "write");
  pid_t ended = 0;
  while ((ended = waitpid(child, nullptr, 0)) == -1 && errno == EINTR) {
  }
  EXPECT(ended == child, "waitpid");
  for (const int end : {ready[0], ready[1], release[0], release[1]}) close(end);
  close(fd);
}

// Readers share it.
void Shared() {
  const int one = Open(), two = Open();
  const std::int64_t start = Now();
  EXPECT(flock(one, LOCK_SH) == 0 && flock(two, LOCK_SH) == 0, "flock");
  EXPECT(flock(one, LOCK_EX | LOCK_NB) == -1 && errno == EWOULDBLOCK, "%s", strerror(errno));
  ExpectPassed(start, 0, "shared locks");
  close(one);
  close(two);
}

// Both want what the other one has: the kernel finds out.
void Deadlock() {
  const int fd = Open();
  const auto lock = [fd](int command, int at) {
    struct flock part = Record(F_WRLCK);
    part.l_start = at;
    return fcntl(fd, command, &part);
  };
  EXPECT(lock(F_SETLK, 0) == 0, "fcntl");
  InOrder& order = NewOrder();
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    EXPECT(lock(F_SETLKW, 100) == 0, "fcntl");
    SleepUntil(start + 50 * kMs);
    order.Comes(0);
    _exit(lock(F_SETLKW, 0) == 0 ? 0 : 1);
  }
  SleepUntil(start + 100 * kMs);
  order.AwaitAll(1);
  EXPECT(lock(F_SETLKW, 100) == -1 && errno == EDEADLK, "%s", strerror(errno));
  ExpectPassed(start, 100 * kMs, "EDEADLK");
  EXPECT(lock(F_SETLKW, 200) == 0, "fcntl");
  close(fd);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %x", status);
  ExpectPassed(start, 100 * kMs, "the other one");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  ForEachAtOnceNatively(kKinds, [](const Kind& kind) {
    MakeFile();
    for (const Ends ends : {Ends::kByCall, Ends::kByClose, Ends::kByExit}) {
      BetweenProcesses(kind, ends);
    }
    ServedInOrder(kind);
    Interrupted(kind);
    unlink(g_path);
  });
  MakeFile();
  Shared();
  Deadlock();
  unlink(g_path);
}
