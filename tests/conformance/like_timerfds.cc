// A timer's descriptor is a timerfd in every call: what it refuses, what it is called, and in the
// hands of others.
#include <fcntl.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/timerfd.h>
#include <sys/uio.h>
#include <sys/wait.h>

#include <string>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr unsigned long kSetTicks = _IOW('T', 0, std::uint64_t);  // <linux/timerfd.h> has it

void Set(int fd, std::int64_t first_ns, std::int64_t interval_ns = 0) {
  const itimerspec spec{ToTimespec(interval_ns), ToTimespec(first_ns)};
  EXPECT(timerfd_settime(fd, 0, &spec, nullptr) == 0, "timerfd_settime: %s", strerror(errno));
}

std::uint64_t Expirations(int fd) {
  std::uint64_t count = 0;
  EXPECT(read(fd, &count, sizeof count) == sizeof count, "read: %s", strerror(errno));
  return count;
}

void Refuses(int fd) {
  const std::uint64_t most = UINT64_MAX - 1, one = 1;
  std::uint64_t count = 0;
  for (const std::uint64_t value : {one, most}) {
    EXPECT(write(fd, &value, sizeof value) == -1 && errno == EINVAL, "write: %s", strerror(errno));
    EXPECT(syscall(SYS_write, fd, &value, sizeof value) == -1 && errno == EINVAL, "write, raw: %s",
           strerror(errno));
  }
  iovec piece{&count, sizeof count};
  EXPECT(writev(fd, &piece, 1) == -1 && errno == EINVAL, "writev: %s", strerror(errno));
  EXPECT(syscall(SYS_writev, fd, &piece, 1) == -1 && errno == EINVAL, "writev, raw");
  EXPECT(write(fd, &one, 0) == -1 && errno == EINVAL, "an empty write");
  // Of an armed timer, too, whether there is something to be read or not.
  for (const bool runs_out : {false, true}) {
    Set(fd, runs_out ? kMs : kSecond);
    usleep(10'000);
    const std::int64_t start = Now();
    EXPECT(read(fd, &count, 7) == -1 && errno == EINVAL, "a short read: %s", strerror(errno));
    EXPECT(syscall(SYS_read, fd, &count, 4) == -1 && errno == EINVAL, "a short read, raw");
    piece.iov_len = 4;
    EXPECT(readv(fd, &piece, 1) == -1 && errno == EINVAL, "a short readv: %s", strerror(errno));
    ExpectWaited(start, 0, 4, "what is refused");
    pollfd polled{fd, POLLIN | POLLOUT, 0};
    EXPECT(poll(&polled, 1, 0) == (runs_out ? 1 : 0) && polled.revents == (runs_out ? POLLIN : 0),
           "poll says %x", (unsigned)polled.revents);
  }
  EXPECT(Expirations(fd) == 1, "refused reads took it");
}

void IsCalled(int fd) {
  const std::string number = std::to_string(fd);
  char name[64] = {}, info[1024] = {};
  EXPECT(readlink(("/proc/self/fd/" + number).c_str(), name, sizeof name - 1) > 0, "readlink");
  EXPECT(strcmp(name, "anon_inode:[timerfd]") == 0, "it is called %s", name);
  Set(fd, kMs, kMs);
  usleep(10'500);
  Set(fd, 0);  // what it has run out is forgotten
  const int file = open(("/proc/self/fdinfo/" + number).c_str(), O_RDONLY);
  EXPECT(read(file, info, sizeof info - 1) > 0, "fdinfo");
  close(file);
  EXPECT(strstr(info, "\nclockid: 1\nticks: 0\n") != nullptr, "its information: %s", info);
  EXPECT((fcntl(fd, F_GETFL) & (O_ACCMODE | O_NONBLOCK)) == O_RDWR, "its flags");
}

// How often it has run out can be set, where the kernel is built for that.
void TakesTicks(int fd) {
  std::uint64_t ticks = 5;
  if (ioctl(fd, kSetTicks, &ticks) != 0) return;
  EXPECT(Expirations(fd) == 5, "the ticks that were set");
  ticks = 0;
  EXPECT(ioctl(fd, kSetTicks, &ticks) == -1 && errno == EINVAL, "no ticks");
  // What has not been read is added to.
  ticks = 3;
  EXPECT(ioctl(fd, kSetTicks, &ticks) == 0, "ticks");
  Set(fd, 5 * kMs);
  usleep(20'000);
  EXPECT(Expirations(fd) == 1, "setting it forgets them");
  Set(fd, 5 * kMs);
  ticks = 3;
  EXPECT(ioctl(fd, kSetTicks, &ticks) == 0, "ticks");
  usleep(20'000);
  EXPECT(Expirations(fd) == 4 || g_mode == Mode::kNative, "they are added to");
}

void DoesNotWait(int fd) {
  std::uint64_t count;
  const int flags = fcntl(fd, F_GETFL);
  EXPECT(fcntl(fd, F_SETFL, flags | O_NONBLOCK) == 0, "F_SETFL");
  EXPECT(read(fd, &count, sizeof count) == -1 && errno == EAGAIN, "read: %s", strerror(errno));
  EXPECT(syscall(SYS_read, fd, &count, sizeof count) == -1 && errno == EAGAIN, "read, raw");
  EXPECT(fcntl(fd, F_SETFL, flags) == 0, "F_SETFL");
  const std::int64_t start = Now();
  Set(fd, 30 * kMs);
  EXPECT(Expirations(fd) == 1, "one");
  ExpectSoonAfter(start, 30 * kMs, "a read that waits again");
}

int PassOverSocket(int fd) {
  int ends[2];
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) == 0, "socketpair");
  char byte = 0;
  iovec piece{&byte, 1};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof fd)] = {};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(sizeof fd);
  memcpy(CMSG_DATA(header), &fd, sizeof fd);
  EXPECT(sendmsg(ends[0], &message, 0) == 1, "sendmsg: %s", strerror(errno));
  EXPECT(recvmsg(ends[1], &message, 0) == 1, "recvmsg: %s", strerror(errno));
  int passed = -1;
  memcpy(&passed, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof passed);
  close(ends[0]);
  close(ends[1]);
  return passed;
}

// Copies, and those of children, are one timer.
void IsShared(int fd) {
  const int copies[] = {dup(fd), fcntl(fd, F_DUPFD_CLOEXEC, 100), PassOverSocket(fd)};
  for (const int copy : copies) {
    std::int64_t start = Now();
    Set(copy, 20 * kMs);
    EXPECT(Expirations(fd) == 1, "set by a copy");
    ExpectSoonAfter(start, 20 * kMs, "a copy's timer");
    start = Now();
    Set(fd, 20 * kMs);
    EXPECT(Expirations(copy) == 1, "read by a copy");
    ExpectSoonAfter(start, 20 * kMs, "the timer of a copy");
  }
  for (const int copy : copies) close(copy);
  std::int64_t start = Now();
  Set(fd, 40 * kMs);
  const pid_t child = fork();
  if (child == 0) {
    Expirations(fd);
    ExpectSoonAfter(start, 40 * kMs, "a child's read");
    start = Now();
    Set(fd, 25 * kMs);
    Expirations(fd);
    ExpectSoonAfter(start, 25 * kMs, "a child's timer");
    _exit(0);
  }
  int status = -1;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "the child's status is %x", status);
}

// The program that it executes has the timer, armed as it was.
void LivesOnInExec(const char* self, const char* mode) {
  const int fd = timerfd_create(CLOCK_MONOTONIC, 0);
  Set(fd, 60 * kMs);
  const std::int64_t start = Now();
  const std::string number = std::to_string(fd), since = std::to_string(start);
  const pid_t child = fork();
  if (child == 0) {
    execl(self, self, mode, "--reads", number.c_str(), since.c_str(), nullptr);
    _exit(9);
  }
  int status = -1;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "the child's status is %x", status);
  close(fd);
}

int ReadInherited(char** argv) {
  if (strcmp(argv[1], "native") != 0) {
    g_mode = strcmp(argv[1], "fixed") == 0 ? Mode::kFixed : Mode::kMeasured;
  }
  EXPECT(Expirations(atoi(argv[3])) == 1, "inherited");
  // What a program's start costs is the host's, and may be more than the timer's time.
  ExpectSoonAfter(atoll(argv[4]), 59 * kMs, "an inherited timer",
                  (g_mode == Mode::kMeasured ? 300 : 20) * kMs);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 5) return ReadInherited(argv);
  Begin(argc, argv);
  for (const bool raw : {false, true}) {
    const int fd = raw ? static_cast<int>(syscall(SYS_timerfd_create, CLOCK_MONOTONIC, 0))
                       : timerfd_create(CLOCK_MONOTONIC, 0);
    EXPECT(fd >= 0, "timerfd_create: %s", strerror(errno));
    Refuses(fd);
    IsCalled(fd);
    TakesTicks(fd);
    DoesNotWait(fd);
    IsShared(fd);
    close(fd);
  }
  LivesOnInExec(argv[0], argc > 1 ? argv[1] : "native");
}
