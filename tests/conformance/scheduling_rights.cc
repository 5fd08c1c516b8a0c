// Who may ask the scheduler for what, what a reset on fork does, and that calls made without the C
// library see the same scheduler. Which rights the program has it asks the kernel: root may lack
// them. Natively nothing can be expected where the kernel refuses SCHED_FIFO to a program that has
// the right (a group without a budget). Under tcs that is the host's, and not the robot's.
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <algorithm>

#include "tests/conformance/conformance.h"
#include "tests/conformance/rights.h"

using namespace conformance;

namespace {

constexpr uid_t kNobody = 65534;

struct Attributes {
  std::uint32_t size, policy;
  std::uint64_t flags;
  std::int32_t nice;
  std::uint32_t priority;
  std::uint64_t runtime, deadline, period;
  std::uint32_t least, most;
};

int Ask(pid_t pid, int policy, int priority) {
  const sched_param param{priority};
  return sched_setscheduler(pid, policy, &param) == 0 ? 0 : errno;
}

void Expect(int error, int wanted, const char* what) {
  EXPECT(error == wanted, "%s: %s instead of %s", what, strerrorname_np(error),
         strerrorname_np(wanted));
}

template <class Program>
void InAChild(const char* what, Program program) {
  const pid_t pid = fork();
  if (pid == 0) {
    program();
    _exit(0);
  }
  int status = -1;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "%s: status %x", what, status);
}

bool g_is_privileged = false;   // by CAP_SYS_NICE
bool g_becomes_nobody = false;  // may become a user without capabilities
int g_highest = 0;              // the highest priority that the program may have

rlim_t Limit(__rlimit_resource resource) {
  rlimit limit{};
  EXPECT(getrlimit(resource, &limit) == 0, "getrlimit: %s", strerror(errno));
  return limit.rlim_cur;
}

bool MayBecomeNobody() {
  const pid_t pid = fork();
  if (pid == 0) _exit(setresuid(kNobody, kNobody, kNobody) == 0 ? 0 : 1);
  int status = -1;
  return waitpid(pid, &status, 0) == pid && status == 0;
}

// Robots allow every priority to the programs of a user whom the host gives neither the capability
// nor any limit.
int HighestPriority() {
  constexpr rlim_t kHighest = 99;
  const rlim_t limit = Limit(RLIMIT_RTPRIO);
  const bool is_robots = g_mode != Mode::kNative && limit == 0;
  return static_cast<int>(g_is_privileged || is_robots ? kHighest : std::min(limit, kHighest));
}

// Without the capability, and without a limit.
void BecomeOrdinary() {
  const rlimit none{0, 0};
  EXPECT(setrlimit(RLIMIT_RTPRIO, &none) == 0, "setrlimit: %s", strerror(errno));
  EXPECT(setresuid(kNobody, kNobody, kNobody) == 0, "setresuid");
}

void* DoNothing(void*) { return nullptr; }

int ThreadOf(int policy, int priority) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&attributes, policy);
  const sched_param param{priority};
  pthread_attr_setschedparam(&attributes, &param);
  pthread_t thread;
  const int error = pthread_create(&thread, &attributes, DoNothing, nullptr);
  if (error == 0) pthread_join(thread, nullptr);
  return error;
}

// What every user without the capability may, whatever the limit of real-time priorities.
void OrdinaryRights() {
  Expect(Ask(0, SCHED_FIFO, 100), EINVAL, "priority 100");
  Expect(ThreadOf(SCHED_OTHER, 0), 0, "an ordinary thread");
  Expect(Ask(0, SCHED_BATCH, 0), 0, "SCHED_BATCH");
  Expect(Ask(0, SCHED_OTHER, 0), 0, "SCHED_OTHER");
  if (Limit(RLIMIT_NICE) == 0) {
    EXPECT(setpriority(PRIO_PROCESS, 0, -5) == -1 && errno == EACCES, "setpriority");
    EXPECT(nice(-1) == -1 && errno == EPERM, "nice");
  }
  EXPECT(setpriority(PRIO_PROCESS, 0x3ffffff, 0) == -1 && errno == ESRCH, "nobody's priority");
  cpu_set_t cores;
  EXPECT(sched_getaffinity(0, sizeof cores, &cores) == 0, "sched_getaffinity");
  EXPECT(sched_setaffinity(0, sizeof cores, &cores) == 0, "%s", strerror(errno));
  Attributes deadline{};
  deadline.size = 48;
  deadline.policy = SCHED_DEADLINE;
  deadline.runtime = kMs;
  deadline.deadline = deadline.period = 10 * kMs;
  EXPECT(syscall(SYS_sched_setattr, 0, &deadline, 0) == -1 && errno == EPERM, "SCHED_DEADLINE");
  if (Limit(RLIMIT_NICE) == 0) {
    Expect(Ask(0, SCHED_IDLE, 0), 0, "SCHED_IDLE");
    Expect(Ask(0, SCHED_OTHER, 0), EPERM, "SCHED_OTHER from SCHED_IDLE");
    EXPECT(sched_getscheduler(0) == SCHED_IDLE, "policy %d", sched_getscheduler(0));
  }
}

// A program without the capability.
void LimitsHold() {
  InAChild("a user without the capability", [] {
    Expect(Ask(0, SCHED_FIFO, g_highest), 0, "the highest priority");
    Expect(Ask(0, SCHED_OTHER, 0), 0, "SCHED_OTHER");
    Expect(Ask(0, SCHED_RR, 1), 0, "SCHED_RR");
    Expect(ThreadOf(SCHED_FIFO, g_highest), 0, "a thread of SCHED_FIFO");
    if (g_highest < 99) {
      Expect(Ask(0, SCHED_FIFO, g_highest + 1), EPERM, "a higher priority");
      Expect(ThreadOf(SCHED_FIFO, g_highest + 1), EPERM, "a thread of a higher priority");
    }
    OrdinaryRights();
  });
}

// A program that has given up its privileges.
void OrdinaryUsersMayOnlyLower() {
  InAChild("an ordinary user", [] {
    BecomeOrdinary();
    Expect(Ask(0, SCHED_FIFO, 5), EPERM, "SCHED_FIFO");
    Expect(Ask(0, SCHED_RR, 1), EPERM, "SCHED_RR");
    Expect(ThreadOf(SCHED_FIFO, 5), EPERM, "a thread of SCHED_FIFO");
    Expect(Ask(getppid(), SCHED_OTHER, 0), EPERM, "somebody else's process");
    cpu_set_t cores;
    EXPECT(sched_getaffinity(0, sizeof cores, &cores) == 0, "sched_getaffinity");
    EXPECT(sched_setaffinity(getppid(), sizeof cores, &cores) == -1 && errno == EPERM,
           "somebody else's cores");
    OrdinaryRights();
    const sched_param five{5};
    EXPECT(syscall(SYS_sched_setscheduler, 0, SCHED_FIFO, &five) == -1 && errno == EPERM, "raw");
  });
  InAChild("a user whose priority was high before", [] {
    Expect(Ask(0, SCHED_FIFO, 20), 0, "SCHED_FIFO, as root");
    BecomeOrdinary();
    Expect(Ask(0, SCHED_FIFO, 20), 0, "the same");
    Expect(Ask(0, SCHED_FIFO, 10), 0, "a lower priority");
    Expect(Ask(0, SCHED_FIFO, 20), EPERM, "the old priority");
    Expect(Ask(0, SCHED_RR, 10), EPERM, "another policy");
    const sched_param eleven{11};
    EXPECT(sched_setparam(0, &eleven) == -1 && errno == EPERM, "a higher priority");
    EXPECT(pthread_setschedprio(pthread_self(), 11) == EPERM, "a higher priority of the thread");
    EXPECT(sched_getscheduler(0) == SCHED_FIFO, "policy %d", sched_getscheduler(0));
    Expect(Ask(0, SCHED_OTHER, 0), 0, "SCHED_OTHER");
    Expect(Ask(0, SCHED_FIFO, 1), EPERM, "back again");
  });
  InAChild("a program that acts for a user", [] {
    const rlimit none{0, 0};
    EXPECT(setrlimit(RLIMIT_RTPRIO, &none) == 0, "setrlimit: %s", strerror(errno));
    EXPECT(seteuid(kNobody) == 0, "seteuid");
    Expect(Ask(0, SCHED_FIFO, 5), EPERM, "SCHED_FIFO");
    EXPECT(seteuid(0) == 0, "seteuid");
    Expect(Ask(0, SCHED_FIFO, 5), 0, "SCHED_FIFO, as root again");
  });
}

void LimitsAllowAsMuchAsTheySay() {
  InAChild("a user with RLIMIT_RTPRIO", [] {
    const rlimit ten{10, 10};
    if (setrlimit(RLIMIT_RTPRIO, &ten) != 0) return;  // it takes CAP_SYS_RESOURCE
    if (g_is_privileged) EXPECT(setresuid(kNobody, kNobody, kNobody) == 0, "setresuid");
    Expect(Ask(0, SCHED_FIFO, 10), 0, "priority 10");
    Expect(Ask(0, SCHED_FIFO, 11), EPERM, "priority 11");
    Expect(Ask(0, SCHED_RR, 3), 0, "SCHED_RR");
  });
}

int PolicyOf(void* (*routine)(void*)) {
  pthread_t thread;
  void* policy = nullptr;
  EXPECT(pthread_create(&thread, nullptr, routine, nullptr) == 0, "pthread_create");
  pthread_join(thread, &policy);
  return static_cast<int>(reinterpret_cast<std::intptr_t>(policy));
}

void* ReportPolicy(void*) { return reinterpret_cast<void*>(std::intptr_t{sched_getscheduler(0)}); }

void ResetOnFork() {
  InAChild("a reset on fork", [] {
    Expect(Ask(0, SCHED_FIFO | SCHED_RESET_ON_FORK, 7), 0, "SCHED_RESET_ON_FORK");
    EXPECT(sched_getscheduler(0) == (SCHED_FIFO | SCHED_RESET_ON_FORK), "%x",
           sched_getscheduler(0));
    const sched_param eight{8};
    EXPECT(sched_setparam(0, &eight) == 0, "%s", strerror(errno));
    EXPECT(sched_getscheduler(0) == (SCHED_FIFO | SCHED_RESET_ON_FORK), "after sched_setparam: %x",
           sched_getscheduler(0));
    EXPECT(PolicyOf(ReportPolicy) == SCHED_OTHER, "a thread's policy");
    InAChild("a child", [] {
      EXPECT(sched_getscheduler(0) == SCHED_OTHER, "a child's policy: %x", sched_getscheduler(0));
      sched_param param{99};
      EXPECT(sched_getparam(0, &param) == 0 && param.sched_priority == 0, "a child's priority");
    });
    Attributes attributes{};
    EXPECT(syscall(SYS_sched_getattr, 0, &attributes, sizeof attributes, 0) == 0, "getattr");
    EXPECT(attributes.policy == SCHED_FIFO && attributes.flags == 1 && attributes.priority == 8,
           "policy %u, flags %llx, priority %u", attributes.policy,
           (unsigned long long)attributes.flags, attributes.priority);
    if (!g_is_privileged) {
      Expect(Ask(0, SCHED_FIFO, 7), EPERM, "to take it away");
      return;
    }
    Expect(Ask(0, SCHED_FIFO, 7), 0, "without it again");
    EXPECT(sched_getscheduler(0) == SCHED_FIFO, "%x", sched_getscheduler(0));
    EXPECT(PolicyOf(ReportPolicy) == SCHED_FIFO, "another thread's policy");
  });
  InAChild("a user with a reset on fork", [] {
    Expect(Ask(0, SCHED_BATCH | SCHED_RESET_ON_FORK, 0), 0, "to reset");
    if (g_is_privileged) BecomeOrdinary();
    Expect(Ask(0, SCHED_OTHER, 0), EPERM, "to take it away");
    Expect(Ask(0, SCHED_OTHER | SCHED_RESET_ON_FORK, 0), 0, "to keep it");
    InAChild("a child", [] {
      EXPECT(sched_getscheduler(0) == SCHED_OTHER, "a child's policy: %x", sched_getscheduler(0));
    });
  });
}

void RawCallsSeeTheSame() {
  InAChild("raw calls", [] {
    Expect(Ask(0, SCHED_RR, 33), 0, "SCHED_RR");
    EXPECT(syscall(SYS_sched_getscheduler, 0) == SCHED_RR, "sched_getscheduler");
    EXPECT(syscall(SYS_sched_getscheduler, getpid()) == SCHED_RR, "by number");
    sched_param param{};
    EXPECT(syscall(SYS_sched_getparam, 0, &param) == 0 && param.sched_priority == 33, "priority %d",
           param.sched_priority);
    timespec interval{};
    EXPECT(syscall(SYS_sched_rr_get_interval, 0, &interval) == 0 && interval.tv_nsec > 0, "none");
    Attributes attributes{};
    EXPECT(syscall(SYS_sched_getattr, 0, &attributes, 48, 0) == 0, "%s", strerror(errno));
    EXPECT(attributes.size == 48 && attributes.policy == SCHED_RR && attributes.priority == 33,
           "size %u, policy %u, priority %u", attributes.size, attributes.policy,
           attributes.priority);
    attributes = {};
    attributes.size = 48;
    attributes.policy = SCHED_FIFO;
    attributes.flags = 1;
    attributes.priority = 44;
    if (AreRealTimeCallsFiltered()) return;
    EXPECT(syscall(SYS_sched_setattr, 0, &attributes, 0) == 0, "%s", strerror(errno));
    EXPECT(sched_getscheduler(0) == (SCHED_FIFO | SCHED_RESET_ON_FORK), "setattr");
    EXPECT(sched_getparam(0, &param) == 0 && param.sched_priority == 44, "setattr's priority");
    const auto fails = [](long result, int error) { return result == -1 && errno == error; };
    EXPECT(fails(syscall(SYS_sched_getattr, 0, &attributes, 47, 0), EINVAL), "small");
    EXPECT(fails(syscall(SYS_sched_getattr, 0, &attributes, 4097, 0), EINVAL), "large");
    EXPECT(fails(syscall(SYS_sched_getattr, 0, &attributes, 48, 1), EINVAL), "flags");
    EXPECT(fails(syscall(SYS_sched_getattr, 0x3ffffff, &attributes, 48, 0), ESRCH), "nobody");
    EXPECT(fails(syscall(SYS_sched_getscheduler, -1), EINVAL), "no process");
    EXPECT(fails(syscall(SYS_sched_getparam, 0x3ffffff, &param), ESRCH), "nobody's priority");
    attributes.size = 4;
    EXPECT(fails(syscall(SYS_sched_setattr, 0, &attributes, 0), E2BIG), "small attributes");
    EXPECT(attributes.size >= 48, "it does not say how large they are: %u", attributes.size);
    attributes.size = 48;
    attributes.flags = 0x1000;
    EXPECT(fails(syscall(SYS_sched_setattr, 0, &attributes, 0), EINVAL), "unknown flags");
    EXPECT(fails(syscall(SYS_sched_setattr, 0, &attributes, 1), EINVAL), "flags of the call");
  });
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  g_is_privileged = HasCapability(CAP_SYS_NICE);
  g_becomes_nobody = MayBecomeNobody();
  g_highest = HighestPriority();
  if (Ask(0, SCHED_FIFO, 1) != 0 || Ask(0, SCHED_OTHER, 0) != 0) {
    return g_mode == Mode::kNative ? 0 : 1;
  }
  if (!g_is_privileged) LimitsHold();
  if (g_is_privileged && g_becomes_nobody) OrdinaryUsersMayOnlyLower();
  if (!g_is_privileged || g_becomes_nobody) LimitsAllowAsMuchAsTheySay();
  if (g_highest < 44) return 0;  // natively; what follows asks for as much
  ResetOnFork();
  RawCallsSeeTheSame();
}
