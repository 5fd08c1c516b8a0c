// System calls that no symbol of the C library stands for: made raw, or from inside the library
// (stdio). They read the same clock and wait in the same time as all others.
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>

#include "tests/conformance/conformance.h"
#include "tests/conformance/rights.h"

namespace {

using namespace conformance;

// Waits are bounded below by the clock that both sides of a call show; what the trap itself costs
// is nobody's.
void ExpectTook(std::int64_t start, std::int64_t wanted, const char* what) {
  const std::int64_t took = Now() - start;
  EXPECT(took >= wanted, "%s took %lld ns, which is early", what, (long long)took);
  if (g_mode != Mode::kNative) {
    EXPECT(took < wanted + 10 * kMs, "%s took %lld ns", what, (long long)took);
  }
  if (g_mode == Mode::kFixed) {
    EXPECT((took - wanted) % kCallNs == 0 && took - wanted <= 6 * kCallNs, "%s took %lld ns", what,
           (long long)took);
  }
}

void Clocks() {
  for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME, CLOCK_BOOTTIME}) {
    const std::int64_t before = Now(clock);
    timespec raw;
    EXPECT(syscall(SYS_clock_gettime, clock, &raw) == 0, "%s", strerror(errno));
    const std::int64_t after = Now(clock);
    EXPECT(before <= ToNs(raw) && ToNs(raw) <= after, "clock %d: %lld not in %lld to %lld", clock,
           (long long)ToNs(raw), (long long)before, (long long)after);
  }
  const std::int64_t before = Now(CLOCK_REALTIME);
  timeval tv;
  EXPECT(syscall(SYS_gettimeofday, &tv, nullptr) == 0, "gettimeofday");
  const std::int64_t us = tv.tv_sec * 1'000'000 + tv.tv_usec;
  EXPECT(before / 1000 <= us && us <= Now(CLOCK_REALTIME) / 1000, "gettimeofday: %lld",
         (long long)us);
  // The kernel's may be a tick behind.
  const std::int64_t tick = g_mode == Mode::kNative ? 10 * kMs : 0;
  const long seconds = syscall(SYS_time, nullptr);
  EXPECT(seconds >= (before - tick) / kSecond && seconds <= Now(CLOCK_REALTIME) / kSecond,
         "time: %ld", seconds);
}

// What is no clock, or one that nobody can sleep on or have timers of, is so however the call is
// made.
void WrongClocks() {
  constexpr clockid_t kNone = 77;
  const timespec request = ToTimespec(kMs);
  timespec found;
  timer_t id;
  EXPECT(syscall(SYS_clock_gettime, kNone, &found) == -1 && errno == EINVAL, "no clock is read");
  EXPECT(syscall(SYS_clock_nanosleep, kNone, 0, &request, nullptr) == -1 && errno == EINVAL,
         "a sleep on no clock");
  for (const clockid_t clock : {CLOCK_MONOTONIC_RAW, CLOCK_MONOTONIC_COARSE, CLOCK_REALTIME_COARSE,
                                CLOCK_THREAD_CPUTIME_ID}) {
    EXPECT(syscall(SYS_clock_nanosleep, clock, 0, &request, nullptr) == -1 && errno == EOPNOTSUPP,
           "a sleep on clock %d", clock);
    if (clock == CLOCK_THREAD_CPUTIME_ID) continue;
    EXPECT(syscall(SYS_timer_create, clock, nullptr, &id) == -1 && errno == EOPNOTSUPP,
           "a timer of clock %d", clock);
  }
}

void Sleeps() {
  std::int64_t start = Now();
  const timespec request = ToTimespec(70 * kMs);
  EXPECT(syscall(SYS_nanosleep, &request, nullptr) == 0, "nanosleep");
  ExpectTook(start, 70 * kMs, "nanosleep");
  start = Now();
  const timespec until = ToTimespec(start + 90 * kMs);
  EXPECT(syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == 0,
         "clock_nanosleep");
  ExpectTook(start, 90 * kMs, "clock_nanosleep");
  const timespec wrong{0, 2'000'000'000};
  EXPECT(syscall(SYS_nanosleep, &wrong, nullptr) == -1 && errno == EINVAL, "not refused");
}

void Timeouts() {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  const int set = epoll_create1(0);
  epoll_event event{};
  event.events = EPOLLIN;
  epoll_ctl(set, EPOLL_CTL_ADD, ends[0], &event);

  std::int64_t start = Now();
  pollfd fd{ends[0], POLLIN, 7};
  EXPECT(syscall(SYS_poll, &fd, 1, 30) == 0 && fd.revents == 0, "poll: %d", fd.revents);
  ExpectTook(start, 30 * kMs, "poll");

  start = Now();
  timespec timeout = ToTimespec(31 * kMs);
  fd.revents = 7;
  EXPECT(syscall(SYS_ppoll, &fd, 1, &timeout, nullptr, 8) == 0 && fd.revents == 0, "ppoll");
  ExpectTook(start, 31 * kMs, "ppoll");

  start = Now();
  fd_set reads;
  FD_ZERO(&reads);
  FD_SET(ends[0], &reads);
  timeval tv{0, 32'000};
  EXPECT(syscall(SYS_select, ends[0] + 1, &reads, nullptr, nullptr, &tv) == 0, "select");
  EXPECT(!FD_ISSET(ends[0], &reads), "select left its set");
  ExpectTook(start, 32 * kMs, "select");

  start = Now();
  FD_SET(ends[0], &reads);
  timeout = ToTimespec(33 * kMs);
  EXPECT(syscall(SYS_pselect6, ends[0] + 1, &reads, nullptr, nullptr, &timeout, nullptr) == 0,
         "pselect6");
  ExpectTook(start, 33 * kMs, "pselect6");

  start = Now();
  EXPECT(syscall(SYS_epoll_wait, set, &event, 1, 34) == 0, "epoll_wait");
  ExpectTook(start, 34 * kMs, "epoll_wait");
  start = Now();
  EXPECT(syscall(SYS_epoll_pwait, set, &event, 1, 35, nullptr, 8) == 0, "epoll_pwait");
  ExpectTook(start, 35 * kMs, "epoll_pwait");
  start = Now();
  timeout = ToTimespec(36 * kMs);
  EXPECT(syscall(SYS_epoll_pwait2, set, &event, 1, &timeout, nullptr, 8) == 0, "epoll_pwait2");
  ExpectTook(start, 36 * kMs, "epoll_pwait2");

  // And what is there ends them at once.
  EXPECT(write(ends[1], "x", 1) == 1, "write");
  start = Now();
  fd.revents = 0;
  EXPECT(syscall(SYS_poll, &fd, 1, 1000) == 1 && fd.revents == POLLIN, "poll: %d", fd.revents);
  EXPECT(syscall(SYS_epoll_wait, set, &event, 1, 1000) == 1, "epoll_wait");
  EXPECT(Now() - start < 900 * kMs, "they waited");
  EXPECT(syscall(SYS_poll, &fd, 1, 0) == 1, "poll without waiting");
  close(set);
  close(ends[0]);
  close(ends[1]);
}

// What is no descriptor is said at once, whatever else is waited for.
void ClosedDescriptors() {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  const int closed = dup(ends[0]);
  close(closed);
  const std::int64_t start = Now();
  for (const nfds_t count : {1, 2}) {
    pollfd fds[] = {{closed, POLLIN, 0}, {ends[0], POLLIN, 0}};
    EXPECT(syscall(SYS_poll, fds, count, 60'000) == 1 && fds[0].revents == POLLNVAL, "poll: %d",
           fds[0].revents);
    fds[0].revents = 0;
    const timespec timeout{60, 0};
    EXPECT(syscall(SYS_ppoll, fds, count, &timeout, nullptr, 8) == 1 && fds[0].revents == POLLNVAL,
           "ppoll: %d", fds[0].revents);
  }
  for (int of = 0; of < 3; ++of) {
    fd_set sets[3];
    for (fd_set& set : sets) FD_ZERO(&set);
    FD_SET(ends[0], &sets[0]);
    FD_SET(closed, &sets[of]);
    timeval tv{60, 0};
    const timespec timeout{60, 0};
    EXPECT(
        syscall(SYS_select, closed + 1, &sets[0], &sets[1], &sets[2], &tv) == -1 && errno == EBADF,
        "select's set %d", of);
    EXPECT(
        syscall(SYS_pselect6, closed + 1, &sets[0], &sets[1], &sets[2], &timeout, nullptr) == -1 &&
            errno == EBADF,
        "pselect6's set %d", of);
  }
  EXPECT(Now() - start < 30'000 * kMs, "they waited");
  close(ends[0]);
  close(ends[1]);
}

// A child writes in turns; what the parent reads by `next` has come when it was written.
template <class Next>
void ReadFromChild(const char* what, Next next) {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    for (int turn = 1; turn <= 3; ++turn) {
      const timespec until = ToTimespec(start + turn * 100 * kMs);
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
      EXPECT(syscall(SYS_write, ends[1], "line\n", 5) == 5, "write");
    }
    _exit(0);
  }
  close(ends[1]);
  FILE* stream = fdopen(ends[0], "r");
  for (int turn = 1; turn <= 3; ++turn) {
    next(stream);
    ExpectTook(start, turn * 100 * kMs, what);
  }
  fclose(stream);
  int status = 0;
  EXPECT(syscall(SYS_wait4, child, &status, 0, nullptr) == child && status == 0, "wait4: %x",
         status);
}

void Children() {
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    usleep(50'000);
    _exit(3);
  }
  int status = 0;
  EXPECT(syscall(SYS_wait4, child, &status, WNOHANG, nullptr) == 0, "not yet");
  EXPECT(syscall(SYS_wait4, child, &status, 0, nullptr) == child, "%s", strerror(errno));
  EXPECT(WEXITSTATUS(status) == 3, "status %x", status);
  ExpectSoonAfter(start, 50 * kMs, "wait4");
  EXPECT(syscall(SYS_wait4, -1, &status, 0, nullptr) == -1 && errno == ECHILD, "no child is left");
}

// A stream that is full is waited for.
void FullPipe() {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  const int size = fcntl(ends[1], F_GETPIPE_SZ);
  const std::int64_t start = Now();
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    FILE* stream = fdopen(ends[1], "w");
    for (int i = 0; i < 2 * size; ++i) fputc('x', stream);
    _exit(fclose(stream));
  }
  close(ends[1]);
  usleep(200'000);
  char buffer[4096];
  long total = 0, n = 0;
  while ((n = syscall(SYS_read, ends[0], buffer, sizeof buffer)) > 0) total += n;
  EXPECT(total == 2 * size, "%ld bytes", total);
  ExpectSoonAfter(start, 200 * kMs, "a full pipe", 50 * kMs);
  waitpid(child, nullptr, 0);
}

void Scheduler() {
  const sched_param param{41};
  if (AreRealTimeCallsFiltered()) return;
  if (syscall(SYS_sched_setscheduler, 0, SCHED_FIFO, &param) != 0) {
    EXPECT(g_mode == Mode::kNative, "%s", strerror(errno));
    return;
  }
  sched_param found{};
  EXPECT(sched_getscheduler(0) == SCHED_FIFO, "policy %d", sched_getscheduler(0));
  EXPECT(sched_getparam(0, &found) == 0 && found.sched_priority == 41, "priority");
  const sched_param none{0};
  EXPECT(syscall(SYS_sched_setscheduler, 0, SCHED_OTHER, &none) == 0, "%s", strerror(errno));
  EXPECT(syscall(SYS_sched_setparam, 0, &param) == -1 && errno == EINVAL, "not refused");
  EXPECT(syscall(SYS_sched_yield) == 0, "yield");
  unsigned long cores[16] = {};
  EXPECT(syscall(SYS_sched_getaffinity, 0, sizeof cores, cores) > 0, "%s", strerror(errno));
  if (g_mode != Mode::kNative) EXPECT(cores[0] == 1, "cores %lx", cores[0]);
}

// Programs fall back to calls that are known here.
void Refused() {
  if (g_mode == Mode::kNative) return;
  char parameters[256] = "";
  EXPECT(syscall(SYS_io_uring_setup, 8, parameters) == -1 && errno == ENOSYS, "io_uring");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Clocks();
  WrongClocks();
  Sleeps();
  Timeouts();
  ClosedDescriptors();
  ReadFromChild("fgets", [](FILE* stream) {
    char line[16];
    EXPECT(fgets(line, sizeof line, stream) != nullptr, "fgets");
  });
  ReadFromChild("read", [](FILE* stream) {
    char line[16];
    EXPECT(syscall(SYS_read, fileno(stream), line, sizeof line) == 5, "read");
  });
  Children();
  FullPipe();
  Scheduler();
  Refused();
}
