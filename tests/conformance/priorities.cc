// A SCHED_FIFO thread precedes the SCHED_OTHER threads of its computer from the instant it wakes:
// woken by the clock, by a condition variable, by a datagram; in its own process and from another
// one. And what the scheduling calls set, they report.
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <atomic>

#include "tests/conformance/conformance.h"

namespace {

using namespace conformance;

constexpr int kReadings = 50;
constexpr int kUrgent = 80;

enum class Waker { kClock, kCondition, kDatagram };

// In memory that the two processes share.
struct Shared {
  pthread_mutex_t mutex;
  pthread_cond_t condition;
  bool signalled;
  std::atomic<bool> waiting;
  std::atomic<std::int64_t> sent_ns;      // the computing side's clock before it wakes the other
  std::atomic<std::int64_t> first_ns;     // the urgent side's first reading once awake
  std::atomic<std::int64_t> last_ns;      // and its last one
  std::atomic<std::int64_t> deadline_ns;  // that it sleeps to
};

struct Case {
  Waker waker;
  Shared* shared;
  int sockets[2];
};

bool IsPermitted() {
  const sched_param param{kUrgent};
  const bool permitted = sched_setscheduler(0, SCHED_FIFO, &param) == 0;
  const sched_param none{0};
  sched_setscheduler(0, SCHED_OTHER, &none);
  return permitted;
}

void BecomeUrgent() {
  const sched_param param{kUrgent};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
  EXPECT(error == 0, "%s", strerror(error));
}

void* WaitUrgently(void* raw) {
  const Case& c = *static_cast<Case*>(raw);
  Shared& s = *c.shared;
  BecomeUrgent();
  if (c.waker == Waker::kClock) {
    s.deadline_ns = Now() + 20 * kMs + 333;
    s.waiting = true;
    const timespec until = ToTimespec(s.deadline_ns);
    EXPECT(clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == 0, "sleep");
  } else if (c.waker == Waker::kCondition) {
    pthread_mutex_lock(&s.mutex);
    s.waiting = true;
    while (!s.signalled) pthread_cond_wait(&s.condition, &s.mutex);
  } else {
    s.waiting = true;
    char byte = 0;
    EXPECT(recv(c.sockets[1], &byte, 1, 0) == 1, "%s", strerror(errno));
  }
  s.first_ns = Now();
  std::int64_t now = s.first_ns;
  for (int i = 1; i < kReadings; ++i) {
    const std::int64_t next = Now();
    if (g_mode == Mode::kFixed) {
      EXPECT(next == now + kCallNs, "somebody ran for %lld ns between two readings",
             (long long)(next - now - kCallNs));
    }
    now = next;
  }
  s.last_ns = now;
  if (c.waker == Waker::kCondition) pthread_mutex_unlock(&s.mutex);
  return nullptr;
}

// The waker, which goes on computing.
void WakeTheUrgent(const Case& c) {
  Shared& s = *c.shared;
  while (!s.waiting) usleep(100);
  // Until it really waits.
  const std::int64_t start = Now();
  while (Now() < start + 5 * kMs) {
  }
  if (c.waker == Waker::kCondition) {
    pthread_mutex_lock(&s.mutex);
    s.signalled = true;
    pthread_mutex_unlock(&s.mutex);
    s.sent_ns = Now();
    pthread_cond_signal(&s.condition);
  } else if (c.waker == Waker::kDatagram) {
    s.sent_ns = Now();
    EXPECT(send(c.sockets[0], "x", 1, 0) == 1, "%s", strerror(errno));
  } else {
    s.sent_ns = s.deadline_ns.load();
  }
  const bool fixed_clock = c.waker == Waker::kClock;
  while (Now() < start + (fixed_clock ? 40 : 10) * kMs) {
  }
}

void Check(const Case& c, const char* what) {
  const Shared& s = *c.shared;
  const std::int64_t late = s.first_ns - s.sent_ns;
  EXPECT(late >= 0, "%s: woken %lld ns early", what, (long long)-late);
  if (g_mode == Mode::kMeasured) {
    EXPECT(late < 2 * kMs, "%s: woken %lld ns late", what, (long long)late);
  }
  if (g_mode == Mode::kFixed) {
    // The waker's call, the wait's own return where the call goes on after it, and the reading.
    const int calls = c.waker == Waker::kClock ? 1 : c.waker == Waker::kCondition ? 2 : 2;
    EXPECT(late == calls * kCallNs, "%s: first reading after %lld ns", what, (long long)late);
  }
}

void Run(Waker waker, bool other_process, const char* what) {
  auto* shared = static_cast<Shared*>(
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  EXPECT(shared != MAP_FAILED, "%s", strerror(errno));
  new (shared) Shared{};
  pthread_mutexattr_t of_mutex;
  pthread_mutexattr_init(&of_mutex);
  pthread_mutexattr_setpshared(&of_mutex, PTHREAD_PROCESS_SHARED);
  pthread_mutex_init(&shared->mutex, &of_mutex);
  pthread_condattr_t of_condition;
  pthread_condattr_init(&of_condition);
  pthread_condattr_setpshared(&of_condition, PTHREAD_PROCESS_SHARED);
  pthread_cond_init(&shared->condition, &of_condition);
  Case c{waker, shared, {-1, -1}};
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, c.sockets) == 0, "%s", strerror(errno));
  if (other_process) {
    const pid_t child = fork();
    if (child == 0) {
      WaitUrgently(&c);
      _exit(0);
    }
    WakeTheUrgent(c);
    int status = 0;
    EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %d", status);
  } else {
    pthread_t thread;
    EXPECT(pthread_create(&thread, nullptr, WaitUrgently, &c) == 0, "create");
    WakeTheUrgent(c);
    pthread_join(thread, nullptr);
  }
  Check(c, what);
  munmap(shared, sizeof *shared);
}

void* ReportOwn(void* raw) {
  auto* scheduling = static_cast<int*>(raw);
  sched_param param{};
  pthread_getschedparam(pthread_self(), &scheduling[0], &param);
  scheduling[1] = param.sched_priority;
  return nullptr;
}

void AttributesAreHeeded() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&attributes, SCHED_RR);
  const sched_param param{17};
  pthread_attr_setschedparam(&attributes, &param);
  cpu_set_t first;
  CPU_ZERO(&first);
  CPU_SET(0, &first);
  pthread_attr_setaffinity_np(&attributes, sizeof first, &first);
  int own[2] = {-1, -1};
  pthread_t thread;
  EXPECT(pthread_create(&thread, &attributes, ReportOwn, own) == 0, "create");
  pthread_join(thread, nullptr);
  EXPECT(own[0] == SCHED_RR && own[1] == 17, "policy %d, priority %d", own[0], own[1]);
  int inherit = -1;
  cpu_set_t kept;
  pthread_attr_getinheritsched(&attributes, &inherit);
  pthread_attr_getaffinity_np(&attributes, sizeof kept, &kept);
  EXPECT(inherit == PTHREAD_EXPLICIT_SCHED && CPU_COUNT(&kept) == 1, "attributes were changed");
}

void WhatIsSetIsReported() {
  const sched_param twelve{12};
  EXPECT(sched_setscheduler(0, SCHED_RR, &twelve) == 0, "%s", strerror(errno));
  EXPECT(sched_getscheduler(0) == SCHED_RR, "policy %d", sched_getscheduler(0));
  EXPECT(sched_getscheduler(getpid()) == SCHED_RR, "by number");
  timespec quantum{};
  EXPECT(sched_rr_get_interval(0, &quantum) == 0 && quantum.tv_nsec > 0, "no interval");
  int own[2] = {-1, -1};
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, ReportOwn, own) == 0, "create");
  pthread_join(thread, nullptr);
  EXPECT(own[0] == SCHED_RR && own[1] == 12, "inherited policy %d, priority %d", own[0], own[1]);
  const sched_param none{0};
  EXPECT(sched_setscheduler(0, SCHED_OTHER, &none) == 0, "%s", strerror(errno));
  sched_param now{99};
  EXPECT(sched_getparam(0, &now) == 0 && now.sched_priority == 0, "priority");
}

void WrongValuesAreRefused() {
  const sched_param hundred{100}, none{0};
  EXPECT(sched_setscheduler(0, SCHED_FIFO, &hundred) == -1 && errno == EINVAL, "priority 100");
  EXPECT(sched_setscheduler(0, SCHED_FIFO, &none) == -1 && errno == EINVAL, "priority 0");
  EXPECT(sched_setscheduler(0x3ffffff, SCHED_OTHER, &none) == -1 && errno == ESRCH, "nobody");
  cpu_set_t nothing;
  CPU_ZERO(&nothing);
  EXPECT(sched_setaffinity(0, sizeof nothing, &nothing) == -1 && errno == EINVAL, "no core");
}

// A process that shares its parent's memory, made without the C library's knowledge: the host's
// scheduler does not hear of its wishes either.
int AskForFifo(void*) {
  const sched_param wanted{kUrgent};
  syscall(SYS_sched_setscheduler, 0, SCHED_FIFO, &wanted);
  sched_param now{};
  syscall(SYS_sched_getparam, 0, &now);
  _exit(now.sched_priority);
}

void StrangersAskInVain() {
  static char stack[65'536];
  const pid_t child =
      clone(AskForFifo, stack + sizeof stack, CLONE_VM | CLONE_VFORK | SIGCHLD, nullptr);
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && WIFEXITED(status), "waitpid: %x", status);
  if (g_mode != Mode::kNative) {
    EXPECT(WEXITSTATUS(status) < kUrgent, "priority %d of the host", WEXITSTATUS(status));
  }
}

void AffinityIsOfTheComputersCores() {
  cpu_set_t cores;
  EXPECT(sched_getaffinity(0, sizeof cores, &cores) == 0, "%s", strerror(errno));
  if (g_mode != Mode::kNative) {
    EXPECT(CPU_COUNT(&cores) == sysconf(_SC_NPROCESSORS_ONLN), "%d cores", CPU_COUNT(&cores));
  }
  EXPECT(sched_setaffinity(0, sizeof cores, &cores) == 0, "%s", strerror(errno));
  EXPECT(CPU_ISSET(sched_getcpu(), &cores), "on core %d", sched_getcpu());
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  AffinityIsOfTheComputersCores();
  if (g_mode == Mode::kNative && !IsPermitted()) return 0;
  WrongValuesAreRefused();
  StrangersAskInVain();
  WhatIsSetIsReported();
  AttributesAreHeeded();
  for (const bool other : {false, true}) {
    Run(Waker::kClock, other, "the clock");
    Run(Waker::kCondition, other, "a condition");
    Run(Waker::kDatagram, other, "a datagram");
  }
}
