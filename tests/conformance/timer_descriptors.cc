// timerfd: relative, absolute, periodic, counted, and waited for in all ways.
#include <poll.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/timerfd.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

std::uint64_t Expirations(int fd) {
  std::uint64_t count = 0;
  EXPECT(read(fd, &count, sizeof count) == sizeof count, "read: %s", strerror(errno));
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) {
    const int fd = timerfd_create(clock, TFD_CLOEXEC);
    EXPECT(fd >= 0, "timerfd_create: %s", strerror(errno));
    itimerspec spec{{0, 0}, ToTimespec(70 * kMs)};
    std::int64_t start = Now();
    EXPECT(timerfd_settime(fd, 0, &spec, nullptr) == 0, "timerfd_settime");
    EXPECT(Expirations(fd) == 1, "one expiration");
    ExpectWaited(start, 70 * kMs, 2, "a relative timer");

    start = Now();
    spec.it_value = ToTimespec(Now(clock) + 30 * kMs);
    EXPECT(timerfd_settime(fd, TFD_TIMER_ABSTIME, &spec, nullptr) == 0, "absolute");
    EXPECT(Expirations(fd) == 1, "one expiration");
    ExpectWaited(start, 30 * kMs, 2, "an absolute timer");

    // Expirations that nobody fetched are counted.
    spec = {ToTimespec(10 * kMs), ToTimespec(10 * kMs)};
    timerfd_settime(fd, 0, &spec, nullptr);
    usleep(55'000);
    const std::uint64_t missed = Expirations(fd);
    EXPECT(g_mode == Mode::kNative ? missed >= 5 : missed == 5, "%llu expirations",
           (unsigned long long)missed);
    itimerspec left{};
    EXPECT(timerfd_gettime(fd, &left) == 0, "timerfd_gettime");
    EXPECT(ToNs(left.it_interval) == 10 * kMs, "interval %lld", (long long)ToNs(left.it_interval));
    EXPECT(ToNs(left.it_value) > 0 && ToNs(left.it_value) <= 10 * kMs, "left %lld",
           (long long)ToNs(left.it_value));

    // In poll and epoll.
    pollfd polled{fd, POLLIN, 0};
    Expirations(fd);
    start = Now();
    EXPECT(poll(&polled, 1, 5000) == 1 && (polled.revents & POLLIN) != 0, "poll");
    EXPECT(Now() - start <= (g_mode == Mode::kNative ? kSecond : 15 * kMs), "poll came late");
    const int set = epoll_create1(0);
    epoll_event event{};
    event.events = EPOLLIN;
    epoll_ctl(set, EPOLL_CTL_ADD, fd, &event);
    Expirations(fd);
    EXPECT(epoll_wait(set, &event, 1, 5000) == 1, "epoll_wait");
    close(set);
    Expirations(fd);
    fd_set readable;
    FD_ZERO(&readable);
    FD_SET(fd, &readable);
    EXPECT(select(fd + 1, &readable, nullptr, nullptr, nullptr) == 1 && FD_ISSET(fd, &readable),
           "select");

    // Each period is fetched at its own time, however it is waited for.
    spec = {ToTimespec(10 * kMs), ToTimespec(20 * kMs)};
    start = Now();
    timerfd_settime(fd, 0, &spec, nullptr);
    for (int i = 0; i < 6; ++i) {
      if (i % 2 == 1) EXPECT(poll(&polled, 1, -1) == 1, "poll");
      const std::uint64_t count = Expirations(fd);
      EXPECT(count == 1 || g_mode == Mode::kNative, "%llu expirations", (unsigned long long)count);
      const std::int64_t after = Now() - start, due = (20 + 10 * i) * kMs;
      EXPECT(after >= due, "period %d after %lld ns", i, (long long)after);
      if (g_mode == Mode::kMeasured)
        EXPECT(after < due + 5 * kMs, "period %d after %lld ns", i, (long long)after);
      if (g_mode == Mode::kFixed)
        EXPECT(after <= due + 5 * kCallNs, "period %d after %lld ns", i, (long long)after);
    }

    // At an absolute time that is past it is there at once, with the periods since.
    spec = {ToTimespec(10 * kMs), ToTimespec(Now(clock) - 35 * kMs)};
    start = Now();
    timerfd_settime(fd, TFD_TIMER_ABSTIME, &spec, nullptr);
    const std::uint64_t since = Expirations(fd);
    EXPECT(since >= 4 && (g_mode == Mode::kNative || since == 4), "%llu expirations",
           (unsigned long long)since);
    ExpectWaited(start, 0, 3, "a timer at a past time");

    // Nobody sets the clock, so nothing is cancelled.
    spec = {{0, 0}, ToTimespec(Now(clock) + 30 * kMs)};
    start = Now();
    EXPECT(timerfd_settime(fd, TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET, &spec, nullptr) == 0,
           "TFD_TIMER_CANCEL_ON_SET: %s", strerror(errno));
    EXPECT(Expirations(fd) == 1, "one expiration");
    ExpectSoonAfter(start, 30 * kMs - kMs, "an expiry");
    spec = {ToTimespec(10 * kMs), ToTimespec(10 * kMs)};
    timerfd_settime(fd, 0, &spec, nullptr);

    // Taken away, it never fires.
    spec = {};
    itimerspec old{};
    EXPECT(timerfd_settime(fd, 0, &spec, &old) == 0, "disarm");
    EXPECT(ToNs(old.it_interval) == 10 * kMs, "old interval");
    EXPECT(poll(&polled, 1, 100) == 0, "a disarmed timer fired");
    close(fd);
  }
  const int fd = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  std::uint64_t count;
  EXPECT(read(fd, &count, sizeof count) == -1 && errno == EAGAIN, "a non-blocking read");
  const itimerspec bad{{0, 0}, {0, 1'000'000'000}};
  EXPECT(timerfd_settime(fd, 0, &bad, nullptr) == -1 && errno == EINVAL, "a bad time was taken");
}
