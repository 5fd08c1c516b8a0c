// Closing and copying descriptors: a timer follows its copies, and a program that closes all that
// it does not know keeps its time.
#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/timerfd.h>
#include <sys/wait.h>

#include <thread>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

bool IsOpen(int fd) { return fcntl(fd, F_GETFD) >= 0; }

void ExpectSleeps(const char* after) {
  const std::int64_t start = Now();
  EXPECT(usleep(30'000) == 0, "usleep after %s", after);
  ExpectWaited(start, 30 * kMs, 2, after);
}

void TimerCopies() {
  const int fd = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  const int copy = dup(fd);
  EXPECT(copy >= 0, "dup");
  EXPECT(dup2(fd, copy + 1) == copy + 1 && dup2(fd, fd) == fd, "dup2");
  EXPECT(dup3(fd, copy + 2, O_CLOEXEC) == copy + 2, "dup3");
  EXPECT(fcntl(copy + 2, F_GETFD) == FD_CLOEXEC, "dup3's flag");
  EXPECT(dup3(fd, fd, 0) == -1 && errno == EINVAL, "dup3 onto itself");
  EXPECT(close(fd) == 0 && !IsOpen(fd), "close");
  for (int which = copy; which <= copy + 2; ++which) {
    // Armed through one copy, read through it.
    const itimerspec in_10_ms{{0, 0}, ToTimespec(10 * kMs)};
    EXPECT(timerfd_settime(which, 0, &in_10_ms, nullptr) == 0, "a copy's timer: %s",
           strerror(errno));
    const std::int64_t start = Now();
    pollfd polled{which, POLLIN, 0};
    EXPECT(poll(&polled, 1, 5000) == 1, "poll of copy %d", which - copy);
    ExpectSoonAfter(start, 9 * kMs, "a copy");
    std::uint64_t count = 0;
    EXPECT(read(which, &count, sizeof count) == sizeof count && count == 1, "its expirations");
  }
}

void SleepShortly() {
  const timespec shortly = ToTimespec(50 * kMs);
  nanosleep(&shortly, nullptr);
}

// Threads and processes need no descriptor to be made.
void NoneLeft() {
  const pid_t pid = fork();
  if (pid == 0) {
    rlimit limit;
    getrlimit(RLIMIT_NOFILE, &limit);
    const rlimit few{64, limit.rlim_max};
    EXPECT(setrlimit(RLIMIT_NOFILE, &few) == 0, "setrlimit: %s", strerror(errno));
    while (open("/dev/null", O_RDONLY) >= 0) {
    }
    EXPECT(errno == EMFILE, "open: %s", strerror(errno));
    const std::int64_t start = Now();
    const pid_t child = fork();
    if (child == 0) {
      SleepShortly();
      _exit(7);
    }
    int status = 0;
    EXPECT(waitpid(child, &status, 0) == child && WEXITSTATUS(status) == 7, "status %x", status);
    ExpectSoonAfter(start, 50 * kMs, "a child");
    std::thread(SleepShortly).join();
    ExpectSoonAfter(start, 100 * kMs, "a thread");
    getrlimit(RLIMIT_NOFILE, &limit);
    EXPECT(limit.rlim_cur == 64, "the limit is %ld", static_cast<long>(limit.rlim_cur));
    _exit(0);
  }
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "status %x", status);
}

// A program with few descriptors may use the number of each one.
constexpr char kEveryNumber[] = "every number";
constexpr int kFew = 64;

[[noreturn]] void UseEveryNumber() {
  for (int fd = 3; fd < kFew; ++fd) {
    EXPECT(!IsOpen(fd), "%d is open", fd);
    EXPECT(dup2(2, fd) == fd, "dup2 to %d: %s", fd, strerror(errno));
  }
  for (int fd = kFew; fd < kFew + 9; ++fd) {
    EXPECT(dup2(2, fd) == -1 && errno == EBADF, "dup2 beyond the limit: %s", strerror(errno));
    EXPECT(dup2(fd, 3) == -1 && errno == EBADF, "dup2 from %d", fd);
  }
  EXPECT(dup(2) == -1 && errno == EMFILE, "dup: %s", strerror(errno));
  const pid_t child = fork();
  if (child == 0) _exit(7);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && WEXITSTATUS(status) == 7, "status %x", status);
  for (int fd = 3; fd < kFew; ++fd) EXPECT(close(fd) == 0, "close %d: %s", fd, strerror(errno));
  _exit(0);
}

void EveryNumber(char* mode) {
  const pid_t pid = fork();
  if (pid == 0) {
    rlimit limit;
    getrlimit(RLIMIT_NOFILE, &limit);
    const rlimit few{kFew, limit.rlim_max};
    EXPECT(setrlimit(RLIMIT_NOFILE, &few) == 0, "setrlimit: %s", strerror(errno));
    execl("/proc/self/exe", kEveryNumber, mode, nullptr);
    Fail("exec: %s", strerror(errno));
  }
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "status %x", status);
}

}  // namespace

int main(int argc, char** argv) {
  if (strcmp(argv[0], kEveryNumber) == 0) UseEveryNumber();
  Begin(argc, argv);
  TimerCopies();
  const int low = dup(2);
  EXPECT(dup2(low, 900) == 900, "dup2");
  EXPECT(close_range(900, 1000, 0) == 0 && !IsOpen(900) && IsOpen(low), "close_range");
  EXPECT(close_range(5, 4, 0) == -1 && errno == EINVAL, "close_range of nothing");
  ExpectSleeps("close_range");
  EXPECT(close_range(3, ~0u, CLOSE_RANGE_CLOEXEC) == 0, "close_range to the end");
  EXPECT(fcntl(low, F_GETFD) == FD_CLOEXEC, "close_range's flag");
  ExpectSleeps("close_range to the end");
  closefrom(3);
  EXPECT(!IsOpen(low), "closefrom");
  ExpectSleeps("closefrom");
  for (int fd = 3; fd < 1024; ++fd) close(fd);
  EXPECT(close(500) == -1 && errno == EBADF, "close of nothing");
  ExpectSleeps("closing one by one");
  NoneLeft();
  EveryNumber(argc > 1 ? argv[1] : nullptr);
}
