// Opening one end of a FIFO waits until the other one is opened, to its virtual time.
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <string>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

std::string g_fifo;

// How an end is opened: returns its descriptor.
using Open = int (*)(int flags);

int ByOpen(int flags) { return open(g_fifo.c_str(), flags); }
int ByOpenat(int flags) { return openat(AT_FDCWD, g_fifo.c_str(), flags); }
int ByFopen(int flags) {
  FILE* stream = fopen(g_fifo.c_str(), flags == O_RDONLY ? "r" : "w");
  if (stream == nullptr) return -1;
  const int fd = dup(fileno(stream));
  fclose(stream);
  return fd;
}

// A child opens the other end after 100 ms.
void Meanwhile(const char* what, Open here, int flags, Open there, int other) {
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    const timespec until = ToTimespec(start + 100 * kMs);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    NativelyUntil([] { return Sleeps(getppid()); });
    EXPECT(there(other) >= 0, "%s: %s", what, strerror(errno));
    // Its own open did not wait.
    ExpectPassed(start, 100 * kMs, what);
    usleep(50'000);
    _exit(0);
  }
  const int fd = here(flags);
  EXPECT(fd >= 0, "%s: %s", what, strerror(errno));
  ExpectPassed(start, 100 * kMs, what);
  EXPECT((fcntl(fd, F_GETFL) & O_NONBLOCK) == 0, "%s", what);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %x", status);
  if (flags == O_RDONLY) {
    // Nobody writes any more.
    char byte;
    EXPECT(read(fd, &byte, 1) == 0, "%s", what);
  }
  close(fd);
}

// What is written and closed at once is there, with the end behind it.
void ShortWriter() {
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    usleep(50'000);
    const int fd = open(g_fifo.c_str(), O_WRONLY);
    EXPECT(write(fd, "abc", 3) == 3, "write");
    close(fd);
    _exit(0);
  }
  const int fd = open(g_fifo.c_str(), O_RDONLY);
  char text[8];
  EXPECT(read(fd, text, sizeof text) == 3 && read(fd, text, sizeof text) == 0, "read");
  ExpectPassed(start, 50 * kMs, "a short writer", MostOfChildren());
  close(fd);
  EXPECT(waitpid(child, nullptr, 0) == child, "waitpid");
}

void NotWaited() {
  const std::int64_t start = Now();
  EXPECT(open(g_fifo.c_str(), O_WRONLY | O_NONBLOCK) == -1 && errno == ENXIO, "%s",
         strerror(errno));
  const int reader = open(g_fifo.c_str(), O_RDONLY | O_NONBLOCK);
  EXPECT(reader >= 0, "open");
  const int writer = open(g_fifo.c_str(), O_WRONLY);
  EXPECT(writer >= 0, "open");
  const int both = open(g_fifo.c_str(), O_RDWR);
  EXPECT(both >= 0, "open");
  ExpectPassed(start, 0, "opens that do not wait");
  close(reader);
  close(writer);
  close(both);
}

void Interrupted() {
  struct sigaction action {};
  action.sa_handler = [](int) {};
  sigaction(SIGUSR1, &action, nullptr);
  const pid_t parent = getpid();
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    usleep(40'000);
    NativelyUntil([=] { return Sleeps(parent); });
    _exit(kill(parent, SIGUSR1));
  }
  EXPECT(open(g_fifo.c_str(), O_RDONLY) == -1 && errno == EINTR, "%s", strerror(errno));
  ExpectPassed(start, 40 * kMs, "a handler", MostOfChildren());
  EXPECT(waitpid(child, nullptr, 0) == child, "waitpid");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  char folder[] = "/tmp/tcs_fifo_XXXXXX";
  EXPECT(mkdtemp(folder) != nullptr, "mkdtemp");
  g_fifo = std::string(folder) + "/fifo";
  EXPECT(mkfifo(g_fifo.c_str(), 0600) == 0, "mkfifo");
  const struct {
    const char* name;
    Open how;
  } ways[] = {{"open", ByOpen}, {"openat", ByOpenat}, {"fopen", ByFopen}};
  for (const auto& [name, how] : ways) {
    Meanwhile(name, how, O_RDONLY, how, O_WRONLY);
    Meanwhile(name, how, O_WRONLY, how, O_RDONLY);
  }
  Meanwhile("a reader of one for both", ByOpen, O_RDONLY, ByOpen, O_RDWR);
  Meanwhile("a writer to one for both", ByOpen, O_WRONLY, ByOpen, O_RDWR);
  Meanwhile("a writer to one that does not wait", ByOpen, O_WRONLY, ByOpen, O_RDONLY | O_NONBLOCK);
  ShortWriter();
  NotWaited();
  Interrupted();
  unlink(g_fifo.c_str());
  rmdir(folder);
}
