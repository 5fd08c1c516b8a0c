// One event, one waiter: threads that wait in epoll sets which hold a descriptor with
// EPOLLEXCLUSIVE, in one epoll set, or in accept, read and recv on one descriptor.
#include <fcntl.h>
#include <pthread.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <atomic>
#include <thread>
#include <vector>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

using namespace conformance;

namespace {

constexpr int kWaiters = 4;
constexpr std::int64_t kApartUs = 5'000;

int MakeSet(int fd, std::uint32_t events) {
  const int set = epoll_create1(0);
  epoll_event event{};
  event.events = events;
  EXPECT(epoll_ctl(set, EPOLL_CTL_ADD, fd, &event) == 0, "epoll_ctl: %s", strerror(errno));
  return set;
}

// Returns when the thread, which says its number before, waits.
void AwaitSleep(const std::atomic<pid_t>& tid) {
  do {
    usleep(kApartUs);
  } while (tid == 0 || !Sleeps(tid));
}

// Threads that began to wait one after another; `wait(i)` returns when the i-th has got something.
struct Waiters {
  std::atomic<int> woken{0};
  std::atomic<int> order[kWaiters];
  std::int64_t at_ns[kWaiters] = {};
  std::vector<std::thread> threads;

  template <class Wait>
  explicit Waiters(Wait wait) {
    for (int i = 0; i < kWaiters; ++i) {
      std::atomic<pid_t> tid{0};
      threads.emplace_back([this, i, wait, &tid] {
        tid = gettid();
        wait(i);
        at_ns[i] = Now();
        order[woken++] = i;
      });
      AwaitSleep(tid);
    }
  }
  ~Waiters() {
    for (std::thread& thread : threads) thread.join();
  }

  // Once they had time for it, as many are awake and no more.
  void Expect(int wanted, const char* what) const {
    for (int turn = 0; turn < 200 && woken < wanted; ++turn) usleep(kApartUs);
    usleep(4 * kApartUs);
    EXPECT(woken == wanted, "%s: %d woken instead of %d", what, woken.load(), wanted);
  }
  void ExpectInOrder(const char* what) const {
    for (int i = 0; i < kWaiters; ++i) {
      EXPECT(order[i] == i, "%s: waiter %d came as number %d", what, order[i].load(), i);
    }
  }
  // At the time of the event, if that was the last thing that the waker did.
  void ExpectAt(int waiter, std::int64_t sent_ns, const char* what) const {
    const std::int64_t late = at_ns[waiter] - sent_ns;
    EXPECT(late >= 0, "%s: %lld ns early", what, (long long)-late);
    // Less than what they are apart by.
    const std::int64_t most = (g_mode == Mode::kFixed ? 1 : 4) * kMs;
    if (g_mode != Mode::kNative) EXPECT(late < most, "%s: %lld ns late", what, (long long)late);
  }
};

void Write(int fd) {
  const std::uint64_t one = 1;
  EXPECT(write(fd, &one, sizeof one) == sizeof one, "write: %s", strerror(errno));
}

void Wait(int set) {
  epoll_event event;
  EXPECT(epoll_wait(set, &event, 1, -1) == 1, "epoll_wait: %s", strerror(errno));
}

// A set each. Nobody takes what has come, so that all could find it.
void ExclusiveSets() {
  const int event = eventfd(0, EFD_NONBLOCK);
  int sets[kWaiters];
  for (int& set : sets) set = MakeSet(event, EPOLLIN | EPOLLEXCLUSIVE);
  {
    Waiters waiters([&sets](int i) { Wait(sets[i]); });
    std::int64_t sent = Now();
    Write(event);
    waiters.Expect(1, "EPOLLEXCLUSIVE");
    waiters.ExpectAt(waiters.order[0], sent, "EPOLLEXCLUSIVE");
    // Each further event wakes one more.
    for (int woken = 2; woken <= kWaiters; ++woken) {
      sent = Now();
      Write(event);
      waiters.Expect(woken, "EPOLLEXCLUSIVE, again");
      waiters.ExpectAt(waiters.order[woken - 1], sent, "EPOLLEXCLUSIVE, again");
    }
  }
  for (const int set : sets) close(set);
  close(event);
}

// The same between processes.
void ExclusiveProcesses() {
  const int event = eventfd(0, EFD_NONBLOCK);
  int reports[2];
  EXPECT(pipe(reports) == 0, "pipe");
  pid_t children[kWaiters];
  for (pid_t& child : children) {
    child = fork();
    if (child == 0) {
      Wait(MakeSet(event, EPOLLIN | EPOLLEXCLUSIVE));
      _exit(write(reports[1], "x", 1) == 1 ? 0 : 1);
    }
    AwaitSleep(child);
  }
  for (int wanted = 1; wanted <= kWaiters; ++wanted) {
    Write(event);
    int woken = 0;
    for (int turn = 0; turn < 200 && woken < wanted; ++turn) {
      usleep(kApartUs);
      EXPECT(ioctl(reports[0], FIONREAD, &woken) == 0, "FIONREAD");
    }
    usleep(4 * kApartUs);
    EXPECT(ioctl(reports[0], FIONREAD, &woken) == 0, "FIONREAD");
    EXPECT(woken == wanted, "%d processes woken instead of %d", woken, wanted);
  }
  for (const pid_t child : children) {
    int status = -1;
    EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %x", status);
  }
}

// A set that holds something else, too, is woken by that.
void OtherReasons() {
  const int shared = eventfd(0, EFD_NONBLOCK);
  int own[kWaiters], sets[kWaiters];
  for (int i = 0; i < kWaiters; ++i) {
    sets[i] = MakeSet(shared, EPOLLIN | EPOLLEXCLUSIVE);
    own[i] = eventfd(0, EFD_NONBLOCK);
    epoll_event event{};
    event.events = EPOLLIN;
    EXPECT(epoll_ctl(sets[i], EPOLL_CTL_ADD, own[i], &event) == 0, "epoll_ctl");
  }
  {
    Waiters waiters([&sets](int i) { Wait(sets[i]); });
    Write(shared);
    waiters.Expect(1, "a shared descriptor");
    for (int i = 0; i < kWaiters; ++i) Write(own[i]);
    waiters.Expect(kWaiters, "a descriptor each");
  }
  for (int i = 0; i < kWaiters; ++i) {
    close(own[i]);
    close(sets[i]);
  }
  close(shared);
}

// One set for all.
void OneSet(std::uint32_t flags, const char* what) {
  const int event = eventfd(0, EFD_NONBLOCK), set = MakeSet(event, EPOLLIN | flags);
  {
    Waiters waiters([set](int) { Wait(set); });
    for (int woken = 1; woken <= kWaiters; ++woken) {
      const std::int64_t sent = Now();
      Write(event);
      waiters.Expect(woken, what);
      waiters.ExpectAt(waiters.order[woken - 1], sent, what);
      if ((flags & EPOLLONESHOT) == 0) continue;
      epoll_event again{};
      again.events = EPOLLIN | flags;
      std::uint64_t count;
      EXPECT(read(event, &count, sizeof count) == sizeof count, "read");
      EXPECT(epoll_ctl(set, EPOLL_CTL_MOD, event, &again) == 0, "epoll_ctl");
    }
  }
  close(set);
  close(event);
}

using Read = ssize_t (*)(int, void*, size_t);

void Readers(Read read_one) {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  Waiters waiters([&ends, read_one](int) {
    char byte;
    EXPECT(read_one(ends[0], &byte, 1) == 1, "read: %s", strerror(errno));
  });
  std::int64_t sent = Now();
  EXPECT(write(ends[1], "x", 1) == 1, "write");
  waiters.Expect(1, "read");
  waiters.ExpectAt(0, sent, "read");
  sent = Now();
  // What one leaves is for the others, at once.
  EXPECT(write(ends[1], "xyz", 3) == 3, "write");
  waiters.Expect(kWaiters, "read of three");
  for (int i = 1; i < kWaiters; ++i) waiters.ExpectAt(i, sent, "read of three");
  EXPECT(waiters.order[0] == 0, "waiter %d was the first", waiters.order[0].load());
}

void Receivers() {
  int ends[2];
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) == 0, "socketpair");
  Waiters waiters([&ends](int) {
    char byte;
    EXPECT(recv(ends[0], &byte, 1, 0) == 1, "recv: %s", strerror(errno));
  });
  for (int i = 0; i < kWaiters; ++i) {
    const std::int64_t sent = Now();
    EXPECT(send(ends[1], "x", 1, 0) == 1, "send");
    waiters.Expect(i + 1, "recv");
    waiters.ExpectAt(i, sent, "recv");
  }
  waiters.ExpectInOrder("recv");
}

void Accepters() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  // Of a name that the kernel chooses.
  socklen_t size = sizeof(sa_family_t);
  EXPECT(bind(listener, reinterpret_cast<sockaddr*>(&address), size) == 0, "bind");
  EXPECT(listen(listener, 8) == 0, "listen");
  size = sizeof address;
  EXPECT(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) == 0, "getsockname");
  Waiters waiters([listener](int) {
    EXPECT(accept(listener, nullptr, nullptr) >= 0, "accept: %s", strerror(errno));
  });
  for (int i = 0; i < kWaiters; ++i) {
    const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
    const std::int64_t sent = Now();
    EXPECT(connect(fd, reinterpret_cast<sockaddr*>(&address), size) == 0, "connect");
    waiters.Expect(i + 1, "accept");
    waiters.ExpectAt(i, sent, "accept");
  }
  waiters.ExpectInOrder("accept");
}

// The one that has waited longest, though another one is more urgent.
void LongestWaitingBeforeMostUrgent() {
  const sched_param urgent{10}, none{0};
  if (sched_setscheduler(0, SCHED_FIFO, &urgent) != 0) return;
  sched_setscheduler(0, SCHED_OTHER, &none);
  int ends[2];
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) == 0, "socketpair");
  Waiters waiters([&](int i) {
    const sched_param param{i + 1};
    EXPECT(sched_setscheduler(0, SCHED_FIFO, &param) == 0, "sched_setscheduler");
    char byte;
    EXPECT(recv(ends[0], &byte, 1, 0) == 1, "recv: %s", strerror(errno));
  });
  for (int i = 0; i < kWaiters; ++i) {
    EXPECT(send(ends[1], "x", 1, 0) == 1, "send");
    waiters.Expect(i + 1, "recv of the more urgent");
  }
  waiters.ExpectInOrder("recv of the more urgent");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  ExclusiveSets();
  ExclusiveProcesses();
  OtherReasons();
  OneSet(EPOLLET, "EPOLLET");
  OneSet(EPOLLONESHOT, "EPOLLONESHOT");
  Readers(read);
  Readers([](int fd, void* to, size_t size) -> ssize_t { return syscall(SYS_read, fd, to, size); });
  Receivers();
  Accepters();
  for (int round = 0; round < 8; ++round) LongestWaitingBeforeMostUrgent();
}
