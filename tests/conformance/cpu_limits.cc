// A limit of processor time (RLIMIT_CPU) is one of what was computed: SIGXCPU when it is reached,
// and each second from there on, then SIGKILL. Children have it, and programs that are executed.
#include <signal.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

std::int64_t Computed() { return Now(CLOCK_PROCESS_CPUTIME_ID); }

// The kernel counts the ticks at which the process had the processor. Beside others that is up to a
// fourth more than it has computed; and a virtual machine loses ticks. Under tcs a thread's clock
// may be ahead of what it was charged.
void ExpectNear(std::int64_t computed, std::int64_t wanted, const char* what) {
  const bool is_native = g_mode == Mode::kNative;
  const std::int64_t least = wanted - (is_native ? wanted / 4 : 5 * kMs);
  const std::int64_t most = wanted + (is_native ? 100 * kMs : 5 * kMs);
  EXPECT(computed > least && computed < most, "%s after %lld ns", what, (long long)computed);
}

std::int64_t TimeOf(const rusage& usage) {
  return (usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) * kSecond +
         (usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) * 1000;
}

void Reads(rlim_t soft, rlim_t hard, const char* what) {
  rlimit got{};
  EXPECT(getrlimit(RLIMIT_CPU, &got) == 0 && got.rlim_cur == soft && got.rlim_max == hard,
         "%s: %lld and %lld", what, (long long)got.rlim_cur, (long long)got.rlim_max);
  got = {};
  EXPECT(syscall(SYS_getrlimit, RLIMIT_CPU, &got) == 0 && got.rlim_cur == soft, "%s, raw", what);
  got = {};
  EXPECT(prlimit(0, RLIMIT_CPU, nullptr, &got) == 0 && got.rlim_max == hard, "%s, prlimit", what);
}

void Set(rlim_t soft, rlim_t hard) {
  const rlimit limit{soft, hard};
  EXPECT(setrlimit(RLIMIT_CPU, &limit) == 0, "setrlimit: %s", strerror(errno));
}

volatile sig_atomic_t g_told = 0;

[[noreturn]] void ComputeOn() {
  for (;;) Now();
}

void ToldAndKilled() {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXCPU, [](int) {
      g_told = g_told + 1;
      ExpectNear(Computed(), g_told * kSecond, "it was told");
    });
    Set(1, 2);
    Reads(1, 2, "as set");
    // Sleeping is no computing.
    sleep(1);
    while (g_told == 0) Now();
    Reads(2, 2, "once reached");
    ComputeOn();
  }
  int status = 0;
  rusage usage{};
  EXPECT(wait4(child, &status, 0, &usage) == child, "wait4: %s", strerror(errno));
  EXPECT(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL, "status %x", status);
  ExpectNear(TimeOf(usage), 2 * kSecond, "it was killed");
}

void Inherited() {
  const pid_t child = fork();
  if (child == 0) {
    Set(1, RLIM_INFINITY);
    const pid_t grandchild = fork();
    if (grandchild == 0) {
      Reads(1, RLIM_INFINITY, "a child's");
      ComputeOn();
    }
    int status = 0;
    rusage usage{};
    EXPECT(wait4(grandchild, &status, 0, &usage) == grandchild, "wait4: %s", strerror(errno));
    EXPECT(WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU, "status %x", status);
    ExpectNear(TimeOf(usage), kSecond, "a child was ended");
    Set(77, 78);
    execl("/bin/sh", "sh", "-c", "test $(ulimit -t) = 77", nullptr);
    _exit(9);
  }
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %x", status);
}

void WrongOnes() {
  const rlimit wrong{2, 1};
  EXPECT(setrlimit(RLIMIT_CPU, &wrong) == -1 && errno == EINVAL, "%s", strerror(errno));
  void* volatile nowhere = reinterpret_cast<void*>(1);
  EXPECT(syscall(SYS_setrlimit, RLIMIT_CPU, nowhere) == -1 && errno == EFAULT, "set");
  EXPECT(syscall(SYS_getrlimit, RLIMIT_CPU, nowhere) == -1 && errno == EFAULT, "got");
  EXPECT(syscall(SYS_prlimit64, 0x3fffffff, RLIMIT_CPU, nullptr, nullptr) == -1 && errno == ESRCH,
         "of nobody: %s", strerror(errno));
  const pid_t child = fork();
  if (child == 0) {
    Set(50, 60);
    Reads(50, 60, "set");
    Set(60, 60);
    Reads(60, 60, "raised");
    if (geteuid() != 0) {
      const rlimit more{60, 61};
      EXPECT(setrlimit(RLIMIT_CPU, &more) == -1 && errno == EPERM, "%s", strerror(errno));
    }
    _exit(0);
  }
  int status = 0;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "status %x", status);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  // No image of what ends by SIGXCPU.
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  WrongOnes();
  Inherited();
  // With set costs a second takes a million calls, and without rights these take their time.
  if (g_mode != Mode::kFixed) ToldAndKilled();
}
