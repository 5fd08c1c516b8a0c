// Calls that are rare, and answers to wrong arguments: as the kernel gives them, at the right time.
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/un.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

void* const kNowhere = reinterpret_cast<void*>(1);

#define EXPECT_ERROR(call, error) \
  EXPECT((errno = 0, (call)) == -1 && errno == (error), "%s: %s", #call, strerror(errno))

void AtOnce(std::int64_t start, const char* what) {
  EXPECT(g_mode == Mode::kNative || Now() - start < 5 * kMs, "%s waited", what);
}

// No timer goes off that is set to 0, whatever its interval is; and the interval is forgotten but
// by some.
void DisarmedTimers() {
  const itimerspec given{{1, 0}, {0, 0}};
  itimerspec got{};
  timer_t timer = nullptr;
  sigevent event{};
  event.sigev_notify = SIGEV_NONE;
  EXPECT(timer_create(CLOCK_MONOTONIC, &event, &timer) == 0, "%s", strerror(errno));
  EXPECT(timer_settime(timer, 0, &given, nullptr) == 0, "%s", strerror(errno));
  EXPECT(timer_gettime(timer, &got) == 0 && ToNs(got.it_interval) == 0, "an interval");
  EXPECT(timer_delete(timer) == 0, "%s", strerror(errno));
  int raw = -1;
  EXPECT(syscall(SYS_timer_create, CLOCK_MONOTONIC, &event, &raw) == 0, "%s", strerror(errno));
  EXPECT(syscall(SYS_timer_settime, raw, 0, &given, nullptr) == 0, "%s", strerror(errno));
  EXPECT(syscall(SYS_timer_gettime, raw, &got) == 0 && ToNs(got.it_interval) == 0, "an interval");
  EXPECT_ERROR(syscall(SYS_timer_settime, raw, 0, nullptr, nullptr), EINVAL);
  EXPECT(syscall(SYS_timer_delete, raw) == 0, "%s", strerror(errno));
  for (const bool by_raw : {false, true}) {
    const int fd = by_raw ? static_cast<int>(syscall(SYS_timerfd_create, CLOCK_MONOTONIC, 0))
                          : timerfd_create(CLOCK_MONOTONIC, 0);
    EXPECT((by_raw ? syscall(SYS_timerfd_settime, fd, 0, &given, nullptr)
                   : timerfd_settime(fd, 0, &given, nullptr)) == 0,
           "%s", strerror(errno));
    EXPECT(timerfd_gettime(fd, &got) == 0 && ToNs(got.it_value) == 0, "armed");
    EXPECT(ToNs(got.it_interval) == kSecond, "%lld ns", (long long)ToNs(got.it_interval));
    pollfd readable{fd, POLLIN, 0};
    EXPECT(poll(&readable, 1, 2500) == 0, "it went off");
    close(fd);
  }
  const itimerval interval{{1, 0}, {0, 0}};
  itimerval left{};
  signal(SIGALRM, [](int) { _exit(3); });
  EXPECT(setitimer(ITIMER_REAL, &interval, nullptr) == 0, "%s", strerror(errno));
  EXPECT(getitimer(ITIMER_REAL, &left) == 0 && left.it_interval.tv_sec == 0, "an interval");
  EXPECT(syscall(SYS_setitimer, ITIMER_REAL, &interval, nullptr) == 0, "%s", strerror(errno));
  EXPECT(syscall(SYS_getitimer, ITIMER_REAL, &left) == 0 && left.it_interval.tv_sec == 0, "raw");
  usleep(1'500'000);
}

// What is wrong with a mask is said before anything is waited for.
void WrongMasks() {
  const std::int64_t start = Now();
  const timespec long_time{3600, 0};
  std::uint64_t mask = 0;
  struct {
    const void* mask;
    std::uint64_t size;
  } small{&mask, 4}, nowhere{kNowhere, 8};
  EXPECT_ERROR(syscall(SYS_pselect6, 0, nullptr, nullptr, nullptr, &long_time, kNowhere), EFAULT);
  EXPECT_ERROR(syscall(SYS_pselect6, 0, nullptr, nullptr, nullptr, &long_time, &small), EINVAL);
  EXPECT_ERROR(syscall(SYS_pselect6, 0, nullptr, nullptr, nullptr, &long_time, &nowhere), EFAULT);
  EXPECT_ERROR(syscall(SYS_ppoll, nullptr, 0, &long_time, &mask, 4), EINVAL);
  EXPECT_ERROR(syscall(SYS_ppoll, nullptr, 0, &long_time, kNowhere, 8), EFAULT);
  const int set = epoll_create1(0);
  epoll_event event{};
  EXPECT_ERROR(syscall(SYS_epoll_pwait, set, &event, 1, 3'600'000, &mask, 4), EINVAL);
  EXPECT_ERROR(syscall(SYS_epoll_pwait, set, &event, 1, 3'600'000, kNowhere, 8), EFAULT);
  close(set);
  AtOnce(start, "a wrong mask");
}

int g_leased = -1;

// Whoever opens a file for writing that another process has a lease of waits until it gives that
// up.
void Leases() {
  char path[] = "/tmp/tcs-lease-XXXXXX";
  close(mkstemp(path));
  g_leased = open(path, O_RDONLY);
  int told[2];
  EXPECT(pipe(told) == 0, "%s", strerror(errno));
  signal(SIGIO, [](int) {
    usleep(200'000);
    fcntl(g_leased, F_SETLEASE, F_UNLCK);
  });
  EXPECT(fcntl(g_leased, F_SETLEASE, F_RDLCK) == 0, "a lease: %s", strerror(errno));
  EXPECT(fcntl(g_leased, F_GETLEASE) == F_RDLCK, "no lease");
  const pid_t child = fork();
  if (child == 0) {
    close(g_leased);
    EXPECT_ERROR(open(path, O_WRONLY | O_NONBLOCK), EWOULDBLOCK);
    const std::int64_t start = Now();
    const int opened = open(path, O_WRONLY);
    EXPECT(opened >= 0, "opened: %s", strerror(errno));
    const std::int64_t passed = Now() - start;
    EXPECT(write(told[1], &passed, sizeof passed) == sizeof passed, "told");
    _exit(0);
  }
  std::int64_t passed = 0;
  while (read(told[0], &passed, sizeof passed) < 0 && errno == EINTR) {
  }
  // Under tcs nobody sees such a wait but by its length on the host.
  EXPECT((passed >= 150 * kMs || g_mode != Mode::kNative) &&
             passed < (g_mode == Mode::kNative ? 3000 : 1000) * kMs,
         "it was opened after %lld ns", (long long)passed);
  EXPECT(waitpid(child, nullptr, 0) == child, "%s", strerror(errno));
  EXPECT(fcntl(g_leased, F_GETLEASE) == F_UNLCK, "a lease");
  for (const int fd : {g_leased, told[0], told[1]}) close(fd);
  unlink(path);
}

// Readable at once; changed only when something is mounted.
void Mounts() {
  const int mounts = open("/proc/self/mounts", O_RDONLY);
  pollfd readable{mounts, POLLIN, 0}, changed{mounts, POLLPRI, 0};
  EXPECT(poll(&readable, 1, 1000) == 1 && (readable.revents & POLLIN) != 0, "not readable");
  for (const bool raw : {false, true}) {
    const std::int64_t start = Now();
    const int found =
        raw ? static_cast<int>(syscall(SYS_poll, &changed, 1, 300)) : poll(&changed, 1, 300);
    // Natively others may mount something meanwhile.
    if (g_mode == Mode::kNative && found == 1) continue;
    EXPECT(found == 0, "changed: %x", static_cast<unsigned>(changed.revents));
    ExpectSoonAfter(start, 300 * kMs, "nothing is mounted");
  }
  close(mounts);
}

void ProcessDescriptors() {
  constexpr unsigned kNonblock = O_NONBLOCK;  // PIDFD_NONBLOCK
  const std::int64_t made = Now();
  const pid_t child = fork();
  if (child == 0) {
    usleep(300'000);
    _exit(5);
  }
  const auto blocking = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  const auto fd = static_cast<int>(syscall(SYS_pidfd_open, child, kNonblock));
  EXPECT(fd >= 0 && (fcntl(fd, F_GETFL) & O_NONBLOCK) != 0, "pidfd_open: %s", strerror(errno));
  constexpr auto kOfDescriptor = static_cast<idtype_t>(3);  // P_PIDFD
  siginfo_t info{};
  const std::int64_t start = Now();
  EXPECT_ERROR(waitid(kOfDescriptor, static_cast<id_t>(fd), &info, WEXITED), EAGAIN);
  EXPECT_ERROR(syscall(SYS_waitid, kOfDescriptor, fd, &info, WEXITED, nullptr), EAGAIN);
  AtOnce(start, "a wait by a descriptor that does not block");
  pollfd ended{fd, POLLIN, 0};
  EXPECT(poll(&ended, 1, 100) == 0, "ended");
  EXPECT(waitid(kOfDescriptor, static_cast<id_t>(blocking), &info, WEXITED | WNOWAIT) == 0, "%s",
         strerror(errno));
  const std::int64_t passed = Now() - made;
  EXPECT(passed >= 300 * kMs && (g_mode == Mode::kNative || passed < 320 * kMs + MostOfChildren()),
         "%lld ns", (long long)passed);
  EXPECT(poll(&ended, 1, 0) == 1, "not ended");
  EXPECT(waitid(kOfDescriptor, static_cast<id_t>(fd), &info, WEXITED) == 0, "%s", strerror(errno));
  EXPECT(info.si_pid == child && info.si_status == 5, "status %d", info.si_status);
  EXPECT_ERROR(waitid(kOfDescriptor, static_cast<id_t>(fd), &info, WEXITED), ECHILD);
  close(fd);
  close(blocking);
}

void SecondConnects() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto* to = reinterpret_cast<const sockaddr*>(&address);
  socklen_t size = sizeof address;
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  EXPECT(bind(listener, to, size) == 0 && listen(listener, 4) == 0, "%s", strerror(errno));
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  for (const bool raw : {false, true}) {
    const auto join = [&](int fd) {
      return raw ? static_cast<int>(syscall(SYS_connect, fd, to, size)) : connect(fd, to, size);
    };
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    EXPECT(join(fd) == 0, "connect: %s", strerror(errno));
    EXPECT_ERROR(join(fd), EISCONN);
    EXPECT_ERROR(join(listener), EISCONN);
    close(fd);
    const int slow = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    const bool at_once = join(slow) == 0;
    EXPECT(at_once || errno == EINPROGRESS, "connect: %s", strerror(errno));
    pollfd writable{slow, POLLOUT, 0};
    EXPECT(poll(&writable, 1, 1000) == 1, "not connected");
    // The first one after that says that it is connected, and only the next one that it was.
    if (join(slow) == 0) EXPECT_ERROR(join(slow), EISCONN);
    EXPECT(errno == EISCONN, "connect: %s", strerror(errno));
    close(slow);
    // To nobody: refused, each time.
    const int nobody = socket(AF_INET, SOCK_STREAM, 0), taken = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in other = address;
    other.sin_port = 0;
    EXPECT(bind(taken, reinterpret_cast<sockaddr*>(&other), size) == 0, "%s", strerror(errno));
    socklen_t other_size = sizeof other;
    getsockname(taken, reinterpret_cast<sockaddr*>(&other), &other_size);
    for (int i = 0; i < 2; ++i) {
      EXPECT_ERROR(connect(nobody, reinterpret_cast<sockaddr*>(&other), size), ECONNREFUSED);
    }
    close(nobody);
    close(taken);
    const int local = socket(AF_UNIX, SOCK_STREAM, 0), heard = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    snprintf(name.sun_path + 1, sizeof name.sun_path - 1, "tcs-small-%d-%d", getpid(), raw);
    const auto name_size =
        static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + strlen(name.sun_path + 1));
    const auto* named = reinterpret_cast<const sockaddr*>(&name);
    EXPECT_ERROR(connect(local, named, name_size), ECONNREFUSED);
    EXPECT(bind(heard, named, name_size) == 0, "%s", strerror(errno));
    EXPECT_ERROR(connect(local, named, name_size), ECONNREFUSED);
    EXPECT(listen(heard, 1) == 0 && connect(local, named, name_size) == 0, "%s", strerror(errno));
    EXPECT_ERROR(connect(local, named, name_size), EISCONN);
    close(local);
    close(heard);
  }
  close(listener);
}

// How late the kernel may wake a thread so that it saves power: of no effect in virtual time. What
// was set is read back unless the host has real-time priorities for the run, under which Linux has
// no slack.
void TimerSlack() {
  const int before = prctl(PR_GET_TIMERSLACK);
  EXPECT(before >= 0 && prctl(PR_SET_TIMERSLACK, 50'000'000) == 0, "%s", strerror(errno));
  const int now = prctl(PR_GET_TIMERSLACK);
  EXPECT(now == 50'000'000 || (g_mode != Mode::kNative && now == 0), "%d", now);
  const std::int64_t start = Now();
  usleep(1000);
  ExpectWaited(start, kMs, 2, "a short sleep");
  EXPECT(prctl(PR_SET_TIMERSLACK, 0) == 0, "%s", strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  DisarmedTimers();
  WrongMasks();
  Mounts();
  ProcessDescriptors();
  SecondConnects();
  TimerSlack();
  Leases();
}
