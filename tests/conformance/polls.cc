// poll, select and epoll: the timeout, a descriptor that is ready, and neither.
#include <poll.h>
#include <sys/epoll.h>
#include <sys/select.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

int g_pipe[2], g_epoll;
constexpr std::int64_t kTimeout = 40 * kMs;

int Poll(std::int64_t ns) {
  pollfd fd{g_pipe[0], POLLIN, 0};
  const int n = poll(&fd, 1, ns < 0 ? -1 : static_cast<int>(ns / kMs));
  EXPECT((n == 1) == ((fd.revents & POLLIN) != 0), "poll: %d, revents %x", n, fd.revents);
  return n;
}

int Ppoll(std::int64_t ns) {
  pollfd fd{g_pipe[0], POLLIN, 0};
  const timespec timeout = ToTimespec(ns);
  return ppoll(&fd, 1, ns < 0 ? nullptr : &timeout, nullptr);
}

int Select(std::int64_t ns) {
  fd_set set;
  FD_ZERO(&set);
  FD_SET(g_pipe[0], &set);
  timeval timeout{ns / kSecond, ns % kSecond / 1000};
  const int n = select(g_pipe[0] + 1, &set, nullptr, nullptr, ns < 0 ? nullptr : &timeout);
  EXPECT((n == 1) == (FD_ISSET(g_pipe[0], &set) != 0), "select: %d", n);
  return n;
}

int Pselect(std::int64_t ns) {
  fd_set set;
  FD_ZERO(&set);
  FD_SET(g_pipe[0], &set);
  const timespec timeout = ToTimespec(ns);
  return pselect(g_pipe[0] + 1, &set, nullptr, nullptr, ns < 0 ? nullptr : &timeout, nullptr);
}

int EpollWait(std::int64_t ns) {
  epoll_event event{};
  return epoll_wait(g_epoll, &event, 1, ns < 0 ? -1 : static_cast<int>(ns / kMs));
}

int EpollPwait(std::int64_t ns) {
  epoll_event event{};
  return epoll_pwait(g_epoll, &event, 1, ns < 0 ? -1 : static_cast<int>(ns / kMs), nullptr);
}

int EpollPwait2(std::int64_t ns) {
  epoll_event event{};
  const timespec timeout = ToTimespec(ns);
  return epoll_pwait2(g_epoll, &event, 1, ns < 0 ? nullptr : &timeout, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  EXPECT(pipe(g_pipe) == 0, "pipe");
  g_epoll = epoll_create1(0);
  epoll_event interest{};
  interest.events = EPOLLIN;
  EXPECT(epoll_ctl(g_epoll, EPOLL_CTL_ADD, g_pipe[0], &interest) == 0, "epoll_ctl");

  const struct {
    const char* name;
    int (*wait)(std::int64_t);
    int calls;  // of an expired wait, and of asking for the time
  } kWaits[] = {{"poll", Poll, 2},
                {"ppoll", Ppoll, 2},
                {"select", Select, 2},
                {"pselect", Pselect, 2},
                {"epoll_wait", EpollWait, 2},
                {"epoll_pwait", EpollPwait, 2},
                {"epoll_pwait2", EpollPwait2, 2}};
  for (const auto& w : kWaits) {
    std::int64_t start = Now();
    EXPECT(w.wait(kTimeout) == 0, "%s found something in an empty pipe", w.name);
    ExpectWaited(start, kTimeout, w.calls, w.name);

    start = Now();
    EXPECT(w.wait(0) == 0, "%s found something in an empty pipe", w.name);
    ExpectWaited(start, 0, w.calls, w.name);

    EXPECT(write(g_pipe[1], "x", 1) == 1, "write");
    start = Now();
    EXPECT(w.wait(kTimeout) == 1, "%s missed what was there", w.name);
    ExpectWaited(start, 0, w.calls, w.name);
    EXPECT(w.wait(0) == 1 && w.wait(-1) == 1, "%s missed what was there", w.name);
    char c;
    EXPECT(read(g_pipe[0], &c, 1) == 1, "read");

    // A child writes in the middle of a wait for ever.
    start = Now();
    const pid_t child = fork();
    if (child == 0) {
      usleep(30'000);
      _exit(write(g_pipe[1], "y", 1) == 1 ? 0 : 1);
    }
    EXPECT(w.wait(-1) == 1, "%s did not wait", w.name);
    ExpectSoonAfter(start, 30 * kMs, w.name);
    EXPECT(read(g_pipe[0], &c, 1) == 1 && c == 'y', "read");
  }

  // Nothing to wait for but time.
  std::int64_t start = Now();
  EXPECT(poll(nullptr, 0, 40) == 0, "poll of nothing");
  ExpectWaited(start, kTimeout, 2, "poll of nothing");
  start = Now();
  timeval timeout{0, 40'000};
  EXPECT(select(0, nullptr, nullptr, nullptr, &timeout) == 0, "select of nothing");
  ExpectWaited(start, kTimeout, 2, "select of nothing");
  EXPECT(timeout.tv_sec == 0 && timeout.tv_usec == 0, "select left %ld us", timeout.tv_usec);
}
