// The processors that a program sees are its robot's, of which `tcsim exec` has one, and its
// priority is the one it asks for.
#include <fcntl.h>
#include <linux/openat2.h>
#include <pthread.h>
#include <sched.h>
#include <stddef.h>
#include <sys/resource.h>
#include <sys/rseq.h>
#include <sys/syscall.h>
#include <sys/sysinfo.h>

#include "tests/conformance/conformance.h"
#include "tests/conformance/rights.h"

using namespace conformance;

namespace {

void Cores() {
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  EXPECT(cores >= 1 && cores == get_nprocs(), "%ld processors", cores);
  EXPECT(sysconf(_SC_NPROCESSORS_CONF) == get_nprocs_conf(), "configured processors");
  unsigned cpu = ~0u, node = ~0u;
  EXPECT(getcpu(&cpu, &node) == 0 && cpu < 4096, "getcpu: %u", cpu);
  EXPECT(sched_getcpu() >= 0, "sched_getcpu");
  cpu_set_t set;
  EXPECT(sched_getaffinity(0, sizeof set, &set) == 0, "sched_getaffinity");
  EXPECT(CPU_COUNT(&set) >= 1, "no processor may be used");
  EXPECT(sched_setaffinity(0, sizeof set, &set) == 0, "sched_setaffinity");
  EXPECT(pthread_getaffinity_np(pthread_self(), sizeof set, &set) == 0, "pthread_getaffinity_np");
  EXPECT(pthread_setaffinity_np(pthread_self(), sizeof set, &set) == 0, "pthread_setaffinity_np");
  if (g_mode != Mode::kNative) {
    EXPECT(cores == 1 && cpu == 0 && node == 0 && sched_getcpu() == 0, "%ld cores", cores);
    EXPECT(CPU_COUNT(&set) == 1 && CPU_ISSET(0, &set), "%d cores", CPU_COUNT(&set));
    CPU_ZERO(&set);
    CPU_SET(5, &set);
    EXPECT(sched_setaffinity(0, sizeof set, &set) == -1 && errno == EINVAL, "another's core");
  }
}

// Where the kernel writes the processor into the thread's own memory; negative: it does not.
int CpuOfRseq() {
  int cpu = 0;
  const char* area = static_cast<const char*>(__builtin_thread_pointer()) + __rseq_offset;
  memcpy(&cpu, area + offsetof(struct rseq, cpu_id), sizeof cpu);
  return cpu;
}

// All ways to ask for it name a processor that may be used; of threads, too.
void* CoreOfThread(void*) {
  cpu_set_t set;
  EXPECT(sched_getaffinity(0, sizeof set, &set) == 0, "sched_getaffinity");
  unsigned raw = ~0u;
  EXPECT(syscall(SYS_getcpu, &raw, nullptr, nullptr) == 0, "getcpu: %s", strerror(errno));
  const int by_rseq = CpuOfRseq();
  for (const int cpu : {sched_getcpu(), static_cast<int>(raw), by_rseq < 0 ? 0 : by_rseq}) {
    EXPECT(g_mode == Mode::kNative || CPU_ISSET(cpu, &set), "on processor %d", cpu);
  }
  return nullptr;
}

void CoresOfThreads() {
  CoreOfThread(nullptr);
  pthread_t thread;
  EXPECT(pthread_create(&thread, nullptr, CoreOfThread, nullptr) == 0, "pthread_create");
  pthread_join(thread, nullptr);
}

// Natively these need rights that not everybody has.
void Priorities() {
  sched_param param{};
  int policy = -1;
  param.sched_priority = 20;
  EXPECT(sched_setscheduler(0, SCHED_FIFO, &param) == 0, "sched_setscheduler: %s", strerror(errno));
  EXPECT(sched_getscheduler(0) == SCHED_FIFO, "policy %d", sched_getscheduler(0));
  param.sched_priority = 30;
  EXPECT(sched_setparam(0, &param) == 0, "sched_setparam: %s", strerror(errno));
  EXPECT(sched_getparam(0, &param) == 0 && param.sched_priority == 30, "priority %d",
         param.sched_priority);
  param.sched_priority = 40;
  EXPECT(pthread_setschedparam(pthread_self(), SCHED_RR, &param) == 0, "pthread_setschedparam");
  EXPECT(pthread_setschedprio(pthread_self(), 50) == 0, "pthread_setschedprio");
  EXPECT(pthread_getschedparam(pthread_self(), &policy, &param) == 0, "pthread_getschedparam");
  EXPECT(policy == SCHED_RR && param.sched_priority == 50, "policy %d, priority %d", policy,
         param.sched_priority);
  param.sched_priority = 100;
  EXPECT(sched_setscheduler(0, SCHED_FIFO, &param) == -1 && errno == EINVAL, "priority 100");
  param.sched_priority = 0;
  EXPECT(sched_setscheduler(0, SCHED_OTHER, &param) == 0, "back to SCHED_OTHER");
}

// proc(5): the 40th word of the line, counted from the one in brackets, the second. By the one call
// that opens the host's file.
int PriorityOnTheHost() {
  const open_how how{.flags = O_RDONLY, .mode = 0, .resolve = 0};
  const auto fd =
      static_cast<int>(syscall(SYS_openat2, AT_FDCWD, "/proc/self/stat", &how, sizeof how));
  char text[1024] = {};
  EXPECT(fd >= 0 && read(fd, text, sizeof text - 1) > 0, "/proc/self/stat");
  close(fd);
  const char* word = strrchr(text, ')');
  for (int i = 2; i < 40 && word != nullptr; ++i) word = strchr(word + 1, ' ');
  EXPECT(word != nullptr, "%s", text);
  return atoi(word);
}

// Past the C library, as libnuma does it: the host's scheduler hears nothing of it.
void RawCalls() {
  const int before = PriorityOnTheHost();
  const sched_param highest{99};
  if (AreRealTimeCallsFiltered()) return;
  EXPECT(syscall(SYS_sched_setscheduler, 0, SCHED_FIFO, &highest) == 0, "sched_setscheduler");
  EXPECT(syscall(SYS_sched_setparam, 0, &highest) == 0, "sched_setparam");
  cpu_set_t all;
  memset(&all, 0xff, sizeof all);
  EXPECT(syscall(SYS_sched_setaffinity, 0, sizeof all, &all) == 0, "sched_setaffinity");
  EXPECT(PriorityOnTheHost() == before && before < 99, "the host's priority was %d and became %d",
         before, PriorityOnTheHost());
  sched_param after{};
  EXPECT(syscall(SYS_sched_getparam, 0, &after) == 0 && after.sched_priority == 99,
         "the robot's priority is %d", after.sched_priority);
  const long size = syscall(SYS_sched_getaffinity, 0, sizeof all, &all);
  EXPECT(size > 0 && CPU_COUNT_S(static_cast<std::size_t>(size), &all) == 1, "it runs on %d",
         CPU_COUNT_S(static_cast<std::size_t>(size), &all));
}

// A process that is none of the run's: nobody of the run may schedule it.
void Strangers() {
  const sched_param ordinary{};
  const pid_t nobody = 0x3ffffff, first = 1;
  EXPECT(sched_setscheduler(nobody, SCHED_OTHER, &ordinary) == -1 && errno == ESRCH, "nobody");
  EXPECT(sched_setscheduler(first, 99, &ordinary) == -1 && errno == EINVAL, "policy 99: %s",
         strerror(errno));
  const long raw = syscall(SYS_sched_setscheduler, first, 99, &ordinary);
  EXPECT(raw == -1 && errno == EINVAL, "policy 99, raw: %s", strerror(errno));
  const long unreadable = syscall(SYS_sched_setscheduler, first, SCHED_OTHER, 8);
  EXPECT(unreadable == -1 && errno == EFAULT, "no parameters: %s", strerror(errno));
  if (g_mode == Mode::kNative) return;  // root may
  EXPECT(sched_setscheduler(first, SCHED_OTHER, &ordinary) == -1 && errno == EPERM, "%s",
         strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Cores();
  CoresOfThreads();
  if (g_mode != Mode::kNative) Priorities();
  if (g_mode != Mode::kNative) RawCalls();
  Strangers();
  EXPECT(sched_yield() == 0, "sched_yield");
  errno = 0;
  EXPECT(nice(0) >= -20 && errno == 0, "nice");
  const int least = getpriority(PRIO_PROCESS, 0);
  EXPECT(setpriority(PRIO_PROCESS, 0, least + 1) == 0 && getpriority(PRIO_PROCESS, 0) == least + 1,
         "setpriority: %s", strerror(errno));
  EXPECT(nice(2) == least + 3 && getpriority(PRIO_PROCESS, 0) == least + 3, "nice keeps nothing");
  EXPECT(nice(100) == 19, "nice has a limit");
}
