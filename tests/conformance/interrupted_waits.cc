// The handler of a timer's signal ends a wait, or with SA_RESTART only interrupts it, as signal(7)
// lists them.
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

std::int64_t g_signal_after = 40 * kMs, g_data_after = 90 * kMs;
std::int64_t g_rest = 60 * kMs;  // of a wait, once the signal has come

volatile sig_atomic_t g_handled = 0;
void Count(int) { g_handled = g_handled + 1; }

timer_t g_timer;
std::int64_t g_start;

void Arm() {
  g_handled = 0;
  const itimerspec spec{{0, 0}, ToTimespec(g_signal_after)};
  g_start = Now();
  EXPECT(timer_settime(g_timer, 0, &spec, nullptr) == 0, "timer_settime");
}

void ExpectEnded(std::int64_t after, const char* what) {
  const std::int64_t passed = Now() - g_start;
  EXPECT(g_handled == 1, "%s: %d handlers ran", what, int(g_handled));
  EXPECT(passed >= after, "%s ended after %lld ns", what, (long long)passed);
  if (g_mode == Mode::kMeasured)
    EXPECT(passed < after + 10 * kMs, "%s ended after %lld ns", what, (long long)passed);
  if (g_mode == Mode::kFixed)
    EXPECT(passed <= after + 10 * kCallNs, "%s ended after %lld ns", what, (long long)passed);
}

void ExpectInterrupted(long result, const char* what) {
  EXPECT(result == -1 && errno == EINTR, "%s returned %ld: %s", what, result, strerror(errno));
  ExpectEnded(g_signal_after, what);
}

// What these wait for never comes; SA_RESTART makes no difference.
void NeverRestarted(int fd) {
  Arm();
  const timespec wanted = ToTimespec(g_signal_after + g_rest);
  timespec left{};
  ExpectInterrupted(nanosleep(&wanted, &left), "nanosleep");
  const std::int64_t rest = ToNs(left);
  // The sleep began a little after the timer did.
  EXPECT(rest <= g_rest + 5 * kMs, "nanosleep says %lld ns are left", (long long)rest);
  if (g_mode != Mode::kNative)
    EXPECT(rest > g_rest - 5 * kMs, "nanosleep says %lld ns are left", (long long)rest);
  if (g_mode == Mode::kFixed)
    EXPECT(rest >= g_rest && rest <= g_rest + 5 * kCallNs, "nanosleep says %lld ns are left",
           (long long)rest);

  Arm();
  pollfd polled{fd, POLLIN, 0};
  ExpectInterrupted(poll(&polled, 1, 1000), "poll");
  Arm();
  ExpectInterrupted(poll(nullptr, 0, -1), "poll of nothing");
  Arm();
  fd_set set;
  FD_ZERO(&set);
  FD_SET(fd, &set);
  const std::int64_t whole = g_signal_after + g_rest;
  timeval timeout{whole / kSecond, whole % kSecond / 1000};
  ExpectInterrupted(select(fd + 1, &set, nullptr, nullptr, &timeout), "select");
  const std::int64_t left_ns = timeout.tv_sec * kSecond + timeout.tv_usec * 1000;
  EXPECT(left_ns <= g_rest + 5 * kMs, "%lld ns are left", (long long)left_ns);
  Arm();
  const int epoll = epoll_create1(0);
  epoll_event event{};
  event.events = EPOLLIN;
  epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &event);
  ExpectInterrupted(epoll_wait(epoll, &event, 1, 1000), "epoll_wait");
  close(epoll);

  // A socket with a timeout.
  timeout = {1, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
  Arm();
  char byte;
  ExpectInterrupted(recv(fd, &byte, 1, 0), "recv with a timeout");
  timeout = {0, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
}

template <class Send>
pid_t Later(Send send) {
  const pid_t child = fork();
  if (child != 0) return child;
  const timespec until = ToTimespec(g_start + g_data_after);
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  send();
  _exit(0);
}

void Restarted(bool restart, const sockaddr_in& address, int fd) {
  char byte = 0;
  int status = 0;
  Arm();
  pid_t child = Later(
      [&] { sendto(fd, "x", 1, 0, reinterpret_cast<const sockaddr*>(&address), sizeof address); });
  long result = recv(fd, &byte, 1, 0);
  if (restart) {
    EXPECT(result == 1, "recv: %s", strerror(errno));
    ExpectEnded(g_data_after, "recv");
  } else {
    ExpectInterrupted(result, "recv");
    EXPECT(recv(fd, &byte, 1, 0) == 1, "recv again: %s", strerror(errno));
  }
  waitpid(child, nullptr, 0);

  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  Arm();
  child = Later([&] {
    if (write(ends[1], "x", 1) != 1) _exit(1);
  });
  result = read(ends[0], &byte, 1);
  if (restart) {
    EXPECT(result == 1, "read: %s", strerror(errno));
    ExpectEnded(g_data_after, "read");
  } else {
    ExpectInterrupted(result, "read");
  }
  waitpid(child, nullptr, 0);
  close(ends[0]);
  close(ends[1]);

  Arm();
  child = Later([] {});
  result = waitpid(child, &status, 0);
  if (restart) {
    EXPECT(result == child, "waitpid: %s", strerror(errno));
    EXPECT(g_handled == 1, "%d handlers ran", int(g_handled));
    ExpectSoonAfter(g_start, g_data_after, "waitpid");
  } else {
    ExpectInterrupted(result, "waitpid");
    waitpid(child, &status, 0);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (g_mode == Mode::kNative) {  // a busy machine is late
    g_signal_after *= 3;
    g_data_after = 600 * kMs;
    g_rest = 2 * kSecond;
  }
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGRTMIN + 1;
  EXPECT(timer_create(CLOCK_MONOTONIC, &event, &g_timer) == 0, "timer_create");
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT(bind(fd, reinterpret_cast<sockaddr*>(&address), size) == 0, "bind");
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  for (const bool restart : {false, true}) {
    struct sigaction action {};
    action.sa_handler = Count;
    action.sa_flags = restart ? SA_RESTART : 0;
    sigaction(SIGRTMIN + 1, &action, nullptr);
    NeverRestarted(fd);
    Restarted(restart, address, fd);
  }
}
