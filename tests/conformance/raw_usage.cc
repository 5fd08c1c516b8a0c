// What was computed, and since when the computer is on: the same by raw calls, by the library and
// by the parent, who waits for a child that has computed.
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/sysinfo.h>
#include <sys/times.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

std::int64_t Raw(clockid_t clock) {
  timespec t;
  EXPECT(syscall(SYS_clock_gettime, clock, &t) == 0, "clock %d: %s", clock, strerror(errno));
  return ToNs(t);
}

std::int64_t ToNs(const timeval& t) { return t.tv_sec * kSecond + t.tv_usec * 1000; }
std::int64_t TimeOf(const rusage& usage) { return ToNs(usage.ru_utime) + ToNs(usage.ru_stime); }

void Compute(std::int64_t ns) {
  const std::int64_t until = Now(CLOCK_THREAD_CPUTIME_ID) + ns;
  while (Now(CLOCK_THREAD_CPUTIME_ID) < until) {
  }
}

// `shown` was read between two readings of the clock. Under tcs a thread's clock may be ahead of
// what it was charged, and a timeval cuts off.
void ExpectBetween(std::int64_t before, std::int64_t shown, std::int64_t after, const char* what) {
  const std::int64_t slack = g_mode == Mode::kMeasured ? kMs / 2 : 2'000;
  EXPECT(shown >= before - slack && shown <= after + slack, "%s: %lld not in %lld to %lld", what,
         (long long)shown, (long long)before, (long long)after);
}

void ClocksAgree(const char* where) {
  for (const clockid_t clock : {CLOCK_THREAD_CPUTIME_ID, CLOCK_PROCESS_CPUTIME_ID}) {
    Compute(20 * kMs);
    const std::int64_t before = Now(clock);
    const std::int64_t shown = Raw(clock);
    ExpectBetween(before, shown, Now(clock), where);
    // Whoever computes until such a clock has gone on has computed that.
    const std::int64_t start = Now(clock), raw_start = Raw(clock);
    while (Raw(clock) - raw_start < 20 * kMs) {
    }
    const std::int64_t passed = Now(clock) - start;
    EXPECT(passed >= 20 * kMs - kMs / 2 && (g_mode == Mode::kNative || passed < 25 * kMs),
           "%s: computing 20 ms took %lld ns", where, (long long)passed);
  }
}

void* InThread(void*) {
  ClocksAgree("thread");
  return nullptr;
}

// Of a thread, asked for by another one.
struct Other {
  pthread_barrier_t computed, asked;
  static void* Run(void* argument) {
    auto* other = static_cast<Other*>(argument);
    Compute(30 * kMs);
    pthread_barrier_wait(&other->computed);
    pthread_barrier_wait(&other->asked);
    return nullptr;
  }
};

void OthersClocks() {
  Other other;
  pthread_barrier_init(&other.computed, nullptr, 2);
  pthread_barrier_init(&other.asked, nullptr, 2);
  pthread_t thread;
  pthread_create(&thread, nullptr, Other::Run, &other);
  pthread_barrier_wait(&other.computed);
  clockid_t clock = 0;
  EXPECT(pthread_getcpuclockid(thread, &clock) == 0, "pthread_getcpuclockid");
  const std::int64_t computed = Now(clock);
  EXPECT(computed >= 30 * kMs - kMs / 2 && (g_mode == Mode::kNative || computed < 40 * kMs),
         "another thread has computed %lld ns", (long long)computed);
  pthread_barrier_wait(&other.asked);
  pthread_join(thread, nullptr);
}

void Usages() {
  rusage usage{};
  const auto of = [&](int who) {
    EXPECT(syscall(SYS_getrusage, who, &usage) == 0, "%s", strerror(errno));
    return TimeOf(usage);
  };
  std::int64_t before = Now(CLOCK_PROCESS_CPUTIME_ID);
  // The kernel's own is of its last tick.
  if (g_mode != Mode::kNative) {
    ExpectBetween(before, of(RUSAGE_SELF), Now(CLOCK_PROCESS_CPUTIME_ID), "of the process");
    before = Now(CLOCK_THREAD_CPUTIME_ID);
    ExpectBetween(before, of(RUSAGE_THREAD), Now(CLOCK_THREAD_CPUTIME_ID), "of the thread");
  }
  // Set costs repeat, and how the host divides them does not: all is user time.
  const auto all_is_user_time = [&] {
    return usage.ru_stime.tv_sec == 0 && usage.ru_stime.tv_usec == 0;
  };
  EXPECT(of(RUSAGE_SELF) > 0 && (g_mode != Mode::kFixed || all_is_user_time()), "raw getrusage");
  EXPECT(getrusage(RUSAGE_SELF, &usage) == 0 && (g_mode != Mode::kFixed || all_is_user_time()),
         "getrusage");
  EXPECT(of(RUSAGE_SELF) > 0 && usage.ru_maxrss > 100 && usage.ru_minflt > 10, "%ld KiB, %ld",
         usage.ru_maxrss, usage.ru_minflt);
  EXPECT(syscall(SYS_getrusage, 7, &usage) == -1 && errno == EINVAL, "of nobody");
  const long tick = sysconf(_SC_CLK_TCK);
  tms by_call{}, by_library{};
  const auto since = static_cast<clock_t>(syscall(SYS_times, &by_call));
  const clock_t library_since = times(&by_library);
  EXPECT(library_since - since >= 0 && (g_mode == Mode::kNative || library_since - since <= 1),
         "times: %ld and %ld", since, library_since);
  const clock_t both = by_call.tms_utime + by_call.tms_stime;
  EXPECT(by_library.tms_utime + by_library.tms_stime - both <= tick / 10, "times");
}

void OfChildren() {
  constexpr std::int64_t kComputed = 150 * kMs;
  // The child's start is on its clock.
  const std::int64_t slack = g_mode == Mode::kNative ? kComputed / 2 : MostOfChildren();
  for (const bool waits : {true, false}) {
    const pid_t child = fork();
    if (child == 0) {
      Compute(kComputed);
      _exit(7);
    }
    if (!waits) usleep(2 * kComputed / 1000);
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, waits ? 0 : WNOHANG, &usage) == 0) usleep(10'000);
    EXPECT(WIFEXITED(status) && WEXITSTATUS(status) == 7, "status %x", status);
    EXPECT(TimeOf(usage) >= kComputed - 5 * kMs && TimeOf(usage) < kComputed + slack,
           "wait4 says %lld ns", (long long)TimeOf(usage));
  }
  rusage all{};
  EXPECT(syscall(SYS_getrusage, RUSAGE_CHILDREN, &all) == 0, "%s", strerror(errno));
  EXPECT(TimeOf(all) >= 2 * kComputed - 10 * kMs && TimeOf(all) < 2 * (kComputed + slack),
         "the children: %lld ns", (long long)TimeOf(all));
}

void Uptime() {
  struct sysinfo info {};
  const std::int64_t before = Now(CLOCK_BOOTTIME);
  EXPECT(sysinfo(&info) == 0, "%s", strerror(errno));
  const std::int64_t after = Now(CLOCK_BOOTTIME);
  EXPECT(info.uptime >= before / kSecond && info.uptime <= after / kSecond + 1,
         "sysinfo says %ld s, the clock %lld", info.uptime, (long long)(after / kSecond));
  EXPECT(info.totalram > 0, "no memory");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  ClocksAgree("main");
  pthread_t thread;
  pthread_create(&thread, nullptr, InThread, nullptr);
  pthread_join(thread, nullptr);
  OthersClocks();
  Usages();
  OfChildren();
  Uptime();
}
