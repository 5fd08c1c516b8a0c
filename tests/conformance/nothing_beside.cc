// What tcs has beside a program, threads and processes of its own, shows nowhere; and neither do
// the descriptors that it holds: a pipe ends when the last program closes it, also by exec and by
// its end, and locks stay.
#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <string>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr char kAgain[] = "again";

int CountThreads() {
  int count = 0;
  DIR* tasks = opendir("/proc/self/task");
  EXPECT(tasks != nullptr, "opendir");
  while (const dirent* entry = readdir(tasks)) count += entry->d_name[0] != '.';
  closedir(tasks);
  return count;
}

std::string Children() {
  const std::string path = "/proc/self/task/" + std::to_string(getpid()) + "/children";
  char text[256];
  const int fd = open(path.c_str(), O_RDONLY);
  const ssize_t n = fd < 0 ? 0 : read(fd, text, sizeof text);
  if (fd >= 0) close(fd);
  return std::string(text, static_cast<std::size_t>(n < 0 ? 0 : n));
}

void ExpectAlone() {
  EXPECT(CountThreads() == 1, "%d threads", CountThreads());
  EXPECT(Children().empty(), "children: %s", Children().c_str());
  for (const int extra : {0, __WALL, static_cast<int>(__WCLONE)}) {
    const int options = WNOHANG | extra;
    EXPECT(waitpid(-1, nullptr, options) == -1 && errno == ECHILD, "a child, options %x", options);
  }
  siginfo_t info{};
  EXPECT(waitid(P_ALL, 0, &info, WEXITED | WNOHANG | __WALL) == -1 && errno == ECHILD, "waitid");
  const int lowest = dup(0);
  EXPECT(lowest == 3, "the lowest descriptor is %d", lowest);
  close(lowest);
}

// The raw call, in which the kernel would hold the thread.
ssize_t RawRead(int fd, void* to, std::size_t size) { return syscall(SYS_read, fd, to, size); }

// Until the end of the pipe, which comes `after_ns` from `start`.
void ExpectEnd(int fd, std::int64_t start, std::int64_t after_ns, const char* what) {
  char byte;
  const ssize_t n = RawRead(fd, &byte, 1);
  EXPECT(n == 0, "%s: read %zd", what, n);
  ExpectSoonAfter(start, after_ns, what, 200 * kMs);
}

template <class Run>
void PipeEnds(const char* what, std::int64_t after_ns, int status, Run run) {
  int ends[2];
  EXPECT(pipe2(ends, O_CLOEXEC) == 0, "pipe2");
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    run(ends[1]);
    _exit(9);
  }
  close(ends[1]);
  ExpectEnd(ends[0], start, after_ns, what);
  close(ends[0]);
  int ended = 0;
  EXPECT(waitpid(child, &ended, 0) == child && ended == status, "%s: status %x", what, ended);
  ExpectAlone();
}

void SleepShortly() { usleep(20'000); }

[[noreturn]] void BecomeSleep() {
  execl("/bin/sleep", "sleep", "1", nullptr);
  _exit(8);
}

// A lock of a process, which another one sees.
bool IsLocked(const char* path) {
  const pid_t child = fork();
  if (child == 0) {
    struct flock lock {};
    lock.l_type = F_WRLCK;
    const int fd = open(path, O_RDWR);
    _exit(fd >= 0 && fcntl(fd, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK ? 1 : 0);
  }
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && WIFEXITED(status), "status %x", status);
  return WEXITSTATUS(status) == 1;
}

[[noreturn]] void AfterExec(const char* path) {
  EXPECT(IsLocked(path), "the lock is gone after exec");
  unlink(path);
  exit(0);
}

void LocksStay(const char* self) {
  char path[] = "/tmp/tcs_conformance_XXXXXX";
  const int fd = mkstemp(path);
  EXPECT(fd >= 0, "mkstemp");
  struct flock lock {};
  lock.l_type = F_WRLCK;
  EXPECT(fcntl(fd, F_SETLK, &lock) == 0, "F_SETLK: %s", strerror(errno));
  execl(self, self, kAgain, path, nullptr);
  EXPECT(false, "execl: %s", strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && strcmp(argv[1], kAgain) == 0) AfterExec(argv[2]);
  closefrom(3);  // what the one that runs the test has open
  Begin(argc, argv);
  ExpectAlone();

  PipeEnds("an end", 20 * kMs, 0, [](int) {
    SleepShortly();
    _exit(0);
  });
  PipeEnds("an end by a signal", 20 * kMs, SIGKILL, [](int) {
    SleepShortly();
    raise(SIGKILL);
  });
  // At once, though the program goes on.
  PipeEnds("another program", 20 * kMs, 0, [](int) {
    SleepShortly();
    BecomeSleep();
  });
  PipeEnds("another program at the second try", 20 * kMs, 0, [](int) {
    execl("/nonexistent/sleep", "sleep", nullptr);
    int own[2];
    char byte;
    EXPECT(pipe(own) == 0, "pipe");
    const pid_t child = fork();
    if (child == 0) {
      SleepShortly();
      _exit(write(own[1], "x", 1) == 1 ? 0 : 7);
    }
    EXPECT(RawRead(own[0], &byte, 1) == 1 && byte == 'x', "a raw read after a failed exec");
    EXPECT(waitpid(child, nullptr, 0) == child, "waitpid");
    BecomeSleep();
  });
  PipeEnds("closing all", 20 * kMs, 0, [](int) {
    SleepShortly();
    closefrom(3);
    ExpectAlone();
    sleep(1);
    _exit(0);
  });
  // Signals for everybody in a group are for programs.
  PipeEnds("a signal to the group", 20 * kMs, SIGTERM, [](int) {
    setpgid(0, 0);
    SleepShortly();
    kill(0, SIGTERM);
  });
  LocksStay(argv[0]);
}
