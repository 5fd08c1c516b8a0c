// signalfd: read, polled, selected, in epoll sets; sent to by timers, processes, threads.
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/signalfd.h>
#include <sys/time.h>
#include <sys/wait.h>

#include "tests/conformance/alarm_in.h"
#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

signalfd_siginfo Read(int fd) {
  signalfd_siginfo info{};
  EXPECT(read(fd, &info, sizeof info) == sizeof info, "read: %s", strerror(errno));
  return info;
}

void ExpectPassed(std::int64_t start, std::int64_t wanted, const char* what) {
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= wanted, "%s took %lld ns", what, (long long)passed);
  if (g_mode == Mode::kMeasured)
    EXPECT(passed < wanted + 5 * kMs, "%s: %lld ns", what, (long long)passed);
  if (g_mode == Mode::kFixed)
    EXPECT(passed <= wanted + 10 * kCallNs, "%s: %lld ns", what, (long long)passed);
}

int AddTo(int set, int fd, std::uint64_t data, std::uint32_t events = EPOLLIN) {
  epoll_event event{};
  event.events = events;
  event.data.u64 = data;
  return epoll_ctl(set, EPOLL_CTL_ADD, fd, &event);
}

void ByTimer(int fd) {
  std::int64_t start = Now();
  AlarmIn(40 * kMs);
  EXPECT(Read(fd).ssi_signo == SIGALRM, "another signal");
  ExpectPassed(start, 40 * kMs, "a read");

  pollfd polled{fd, POLLIN, 0};
  start = Now();
  AlarmIn(40 * kMs);
  if (g_mode != Mode::kNative) {  // a busy machine may be late
    EXPECT(poll(&polled, 1, 10) == 0, "poll found something");
    ExpectPassed(start, 10 * kMs, "poll's timeout");
  }
  EXPECT(poll(&polled, 1, 1000) == 1 && polled.revents == POLLIN, "poll");
  ExpectPassed(start, 40 * kMs, "poll");
  Read(fd);
  EXPECT(poll(&polled, 1, 0) == 0, "what was read is still there");

  start = Now();
  AlarmIn(40 * kMs);
  fd_set set;
  FD_ZERO(&set);
  FD_SET(fd, &set);
  timeval timeout{1, 0};
  EXPECT(select(fd + 1, &set, nullptr, nullptr, &timeout) == 1 && FD_ISSET(fd, &set), "select");
  ExpectPassed(start, 40 * kMs, "select");
  Read(fd);
}

// The set also holds a pipe, and is level- or edge-triggered.
void InEpoll(int fd, std::uint32_t trigger) {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  const int set = epoll_create1(0);
  EXPECT(AddTo(set, ends[0], 1) == 0 && AddTo(set, fd, 2, EPOLLIN | trigger) == 0, "epoll_ctl");
  epoll_event event{};
  for (int round = 0; round < 5; ++round) {
    const std::int64_t start = Now();
    AlarmIn(30 * kMs);
    if (g_mode != Mode::kNative)  // a busy machine may be late
      EXPECT(epoll_wait(set, &event, 1, 10) == 0, "round %d: too early", round);
    EXPECT(epoll_wait(set, &event, 1, 1000) == 1 && event.data.u64 == 2, "round %d", round);
    ExpectPassed(start, 30 * kMs, "epoll_wait");
    EXPECT(Read(fd).ssi_signo == SIGALRM, "another signal");
    EXPECT(epoll_wait(set, &event, 1, 0) == 0, "round %d: still ready", round);
  }
  // In a set in a set, and polled as a descriptor.
  const int outer = epoll_create1(0);
  AddTo(outer, set, 3);
  std::int64_t start = Now();
  AlarmIn(30 * kMs);
  EXPECT(epoll_wait(outer, &event, 1, 1000) == 1 && event.data.u64 == 3, "a set in a set");
  ExpectPassed(start, 30 * kMs, "epoll_wait");
  Read(fd);
  EXPECT(epoll_wait(set, &event, 1, 0) == 0, "nothing is left");
  pollfd polled{set, POLLIN, 0};
  start = Now();
  AlarmIn(30 * kMs);
  EXPECT(poll(&polled, 1, 1000) == 1, "a set in poll");
  ExpectPassed(start, 30 * kMs, "poll");
  Read(fd);
  // The other member still wakes.
  start = Now();
  const pid_t child = fork();
  if (child == 0) {
    usleep(20'000);
    _exit(write(ends[1], "x", 1) == 1 ? 0 : 1);
  }
  EXPECT(epoll_wait(set, &event, 1, 1000) == 1 && event.data.u64 == 1, "the pipe");
  waitpid(child, nullptr, 0);
  for (const int used : {ends[0], ends[1], set, outer}) close(used);
}

void FromOthers(int fd) {
  std::int64_t start = Now();
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) {
    usleep(25'000);
    kill(parent, SIGUSR1);
    _exit(0);
  }
  const signalfd_siginfo info = Read(fd);
  EXPECT(info.ssi_signo == SIGUSR1 && info.ssi_pid == static_cast<unsigned>(child), "from %u",
         info.ssi_pid);
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= 25 * kMs, "after %lld ns", (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < 25 * kMs + MostOfChildren(), "after %lld ns", (long long)passed);
  }
  waitpid(child, nullptr, 0);

  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGCHLD);
  const timespec now{};
  while (sigtimedwait(&ends, nullptr, &now) > 0) {
  }
  const int children = signalfd(-1, &ends, SFD_CLOEXEC);
  start = Now();
  const pid_t sleeper = fork();
  if (sleeper == 0) {
    usleep(50'000);
    _exit(5);
  }
  pollfd polled[2] = {{fd, POLLIN, 0}, {children, POLLIN, 0}};
  EXPECT(poll(polled, 2, -1) == 1 && polled[1].revents == POLLIN, "a child's end");
  ExpectSoonAfter(start, 50 * kMs, "a child's end");
  EXPECT(Read(children).ssi_status == 5, "status");
  waitpid(sleeper, nullptr, 0);
  close(children);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGALRM);
  sigaddset(&set, SIGUSR1);
  sigaddset(&set, SIGCHLD);
  sigprocmask(SIG_BLOCK, &set, nullptr);
  sigdelset(&set, SIGCHLD);
  const int fd = signalfd(-1, &set, SFD_CLOEXEC);
  EXPECT(fd >= 0, "signalfd: %s", strerror(errno));
  ByTimer(fd);
  InEpoll(fd, 0);
  InEpoll(fd, EPOLLET);
  FromOthers(fd);
  ByTimer(dup(fd));
  // The set can be changed, and a read need not wait.
  sigset_t other;
  sigemptyset(&other);
  sigaddset(&other, SIGUSR2);
  sigprocmask(SIG_BLOCK, &other, nullptr);
  EXPECT(signalfd(fd, &other, 0) == fd, "signalfd");
  raise(SIGUSR2);
  EXPECT(Read(fd).ssi_signo == SIGUSR2, "the new set");
  const int impatient = signalfd(-1, &other, SFD_NONBLOCK);
  signalfd_siginfo info;
  EXPECT(read(impatient, &info, sizeof info) == -1 && errno == EAGAIN, "a non-blocking read");
  EXPECT(signalfd(-1, &other, 12345) == -1 && errno == EINVAL, "bad flags");
}
