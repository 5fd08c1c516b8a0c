// soak_client KIND SECONDS: one client among many, of one of kKinds, for SECONDS of its own clock.
// It checks what it can see for itself, and ends with 1 and a sentence where that is wrong.
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

namespace {

constexpr std::int64_t kMs = 1'000'000, kSecond = 1'000'000'000;
std::int64_t g_end;

[[noreturn]] void Fail(const char* what) {
  fprintf(stderr, "soak_client: %s\n", what);
  _exit(1);
}

void Expect(bool holds, const char* what) {
  if (!holds) Fail(what);
}

std::int64_t Now(clockid_t clock = CLOCK_MONOTONIC) {
  timespec t;
  clock_gettime(clock, &t);
  return t.tv_sec * kSecond + t.tv_nsec;
}

void SleepTo(std::int64_t ns) {
  const timespec until{ns / kSecond, ns % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  Expect(Now() >= ns, "a sleep ended early");
}

void ComputeFor(std::int64_t ns) {
  const std::int64_t start = Now(CLOCK_THREAD_CPUTIME_ID);
  // Under set costs only calls take time.
  for (int i = 0; i < 10'000 && Now(CLOCK_THREAD_CPUTIME_ID) < start + ns; ++i) {
  }
}

// Work every period, like a controller.
void Periodic() {
  for (std::int64_t next = Now(); next < g_end; next += 20 * kMs) {
    SleepTo(next);
    ComputeFor(20'000);
  }
}

// Work now and then, like a planner.
void Bursts() {
  while (Now() < g_end) {
    ComputeFor(kMs);
    SleepTo(Now() + 500 * kMs);
  }
}

void Threads() {
  std::mutex mutex;
  std::condition_variable changed;
  int produced = 0;
  bool over = false;
  std::vector<std::thread> consumers;
  std::atomic<int> consumed{0};
  for (int i = 0; i < 3; ++i) {
    consumers.emplace_back([&] {
      std::unique_lock lock(mutex);
      for (;;) {
        changed.wait_for(lock, std::chrono::milliseconds(70), [&] { return produced > 0 || over; });
        if (over) return;
        if (produced == 0) continue;
        --produced;
        ++consumed;
      }
    });
  }
  int made = 0;
  for (std::int64_t next = Now(); next < g_end; next += 50 * kMs, ++made) {
    SleepTo(next);
    const std::lock_guard lock(mutex);
    ++produced;
    changed.notify_one();
  }
  SleepTo(Now() + 10 * kMs);
  {
    const std::lock_guard lock(mutex);
    over = true;
    changed.notify_all();
  }
  for (std::thread& consumer : consumers) consumer.join();
  Expect(consumed == made, "a turn was lost between threads");
}

// Threads that come and go.
void Births() {
  while (Now() < g_end) {
    std::thread([] { SleepTo(Now() + 10 * kMs); }).join();
    SleepTo(Now() + 190 * kMs);
  }
}

void Children() {
  while (Now() < g_end) {
    const std::int64_t start = Now();
    const pid_t child = fork();
    if (child == 0) {
      SleepTo(start + 100 * kMs);
      _exit(7);
    }
    int status = 0;
    Expect(waitpid(child, &status, 0) == child && WEXITSTATUS(status) == 7, "a child was lost");
    Expect(Now() >= start + 100 * kMs, "a child ended early");
    SleepTo(Now() + 900 * kMs);
  }
}

// Two processes and a token; it carries the time of its sender.
template <class MakePair>
void Tokens(MakePair make_pair) {
  int ends[2];
  make_pair(ends);
  const pid_t child = fork();
  if (child == 0) {
    std::int64_t sent = 0;
    while (read(ends[1], &sent, sizeof sent) == sizeof sent && sent != 0) {
      Expect(Now() >= sent, "a token came before it was sent");
      SleepTo(Now() + 7 * kMs);
      sent = Now();
      Expect(write(ends[1], &sent, sizeof sent) == sizeof sent, "write");
    }
    _exit(0);
  }
  while (Now() < g_end) {
    std::int64_t token = Now();
    const std::int64_t start = token;
    Expect(write(ends[0], &token, sizeof token) == sizeof token, "write");
    Expect(read(ends[0], &token, sizeof token) == sizeof token, "read");
    Expect(Now() >= token && Now() >= start + 7 * kMs, "an answer came early");
    SleepTo(Now() + 40 * kMs);
  }
  const std::int64_t over = 0;
  Expect(write(ends[0], &over, sizeof over) == sizeof over, "write");
  int status = 0;
  Expect(waitpid(child, &status, 0) == child && status == 0, "the partner failed");
}

volatile sig_atomic_t g_expired;

void Signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_expired = g_expired + 1; };
  sigaction(SIGRTMIN, &action, nullptr);
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGRTMIN);
  sigprocmask(SIG_BLOCK, &blocked, &before);
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGRTMIN;
  timer_t timer;
  Expect(timer_create(CLOCK_MONOTONIC, &event, &timer) == 0, "timer_create");
  const itimerspec every{{0, 50 * kMs}, {0, 50 * kMs}};
  const std::int64_t start = Now();
  timer_settime(timer, 0, &every, nullptr);
  while (Now() < g_end) {
    sigsuspend(&before);
    Expect(Now() >= start + g_expired * 50 * kMs, "a timer was early");
  }
  timer_delete(timer);
}

void Descriptors() {
  const int timer = timerfd_create(CLOCK_MONOTONIC, 0), set = epoll_create1(0);
  const itimerspec every{{0, 30 * kMs}, {0, 30 * kMs}};
  const std::int64_t start = Now();
  timerfd_settime(timer, 0, &every, nullptr);
  epoll_event event{};
  event.events = EPOLLIN;
  epoll_ctl(set, EPOLL_CTL_ADD, timer, &event);
  std::uint64_t expired = 0, more = 0;
  while (Now() < g_end) {
    if (epoll_wait(set, &event, 1, 45) == 1 && read(timer, &more, sizeof more) == sizeof more) {
      expired += more;
    }
    Expect(Now() >= start + static_cast<std::int64_t>(expired) * 30 * kMs, "a timerfd was early");
  }
}

// In a program of its own, given up by its parent, or with what it leaves open and running when it
// ends.
void LiveShortly(int way) {
  if (way == 1) execlp("true", "true", nullptr);
  if (way == 2 && fork() > 0) _exit(0);
  if (way == 3) {
    const int timer = timerfd_create(CLOCK_MONOTONIC, 0), set = epoll_create1(0);
    const itimerspec every{{0, kMs}, {0, kMs}};
    timerfd_settime(timer, 0, &every, nullptr);
    epoll_event event{};
    event.events = EPOLLIN;
    epoll_ctl(set, EPOLL_CTL_ADD, timer, &event);
    Expect(epoll_wait(set, &event, 1, 100) == 1, "a timerfd in an epoll set");
    timer_t own;
    timer_create(CLOCK_MONOTONIC, nullptr, &own);
    std::thread([] { SleepTo(Now() + kMs); }).detach();
  }
  SleepTo(Now() + 2 * kMs);
  _exit(0);
}

// A child each 36 s: 100 an hour.
void Offspring() {
  int way = getpid();
  for (std::int64_t next = Now() + getpid() % 36 * kSecond; next < g_end; next += 36 * kSecond) {
    SleepTo(next);
    way = (way + 1) % 4;
    const pid_t child = fork();
    if (child == 0) LiveShortly(way);
    int status = 0;
    Expect(waitpid(child, &status, 0) == child && status == 0, "a child was lost");
  }
  SleepTo(g_end);
}

void MakePipes(int* ends) { Expect(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0, "socketpair"); }

void MakeDatagrams(int* ends) {
  Expect(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) == 0, "socketpair");
}

struct Kind {
  const char* name;
  void (*run)();
};

const Kind kKinds[] = {
    {"periodic", Periodic},
    {"bursts", Bursts},
    {"threads", Threads},
    {"births", Births},
    {"children", Children},
    {"stream", [] { Tokens(MakePipes); }},
    {"datagrams", [] { Tokens(MakeDatagrams); }},
    {"signals", Signals},
    {"descriptors", Descriptors},
    {"offspring", Offspring},
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  g_end = Now() + static_cast<std::int64_t>(atof(argv[2]) * 1e9);
  for (const Kind& kind : kKinds) {
    if (strcmp(argv[1], kind.name) != 0) continue;
    kind.run();
    return 0;
  }
  Fail("no such kind");
}
