// A signal handler ends a sleep; what was left is told.
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "tests/conformance/alarm_in.h"
#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

volatile sig_atomic_t g_handled = 0;
void Count(int) { g_handled = g_handled + 1; }

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  const bool is_native = g_mode == Mode::kNative;
  // Natively a busy machine may be late.
  const std::int64_t whole = is_native ? 3 * kSecond : 300 * kMs;
  for (const int flags : {0, SA_RESTART}) {  // sleeps end either way
    struct sigaction action {};
    action.sa_handler = Count;
    action.sa_flags = flags;
    sigaction(SIGALRM, &action, nullptr);
    const int before = g_handled;

    std::int64_t start = Now();
    AlarmIn(100 * kMs);
    const timespec wanted = ToTimespec(whole);
    timespec left{};
    EXPECT(nanosleep(&wanted, &left) == -1 && errno == EINTR, "nanosleep was not interrupted");
    const std::int64_t passed = Now() - start;
    EXPECT(g_handled == before + 1, "%d handlers ran", int(g_handled - before));
    EXPECT(passed >= 100 * kMs && passed < whole - 10 * kMs, "after %lld ns", (long long)passed);
    EXPECT(ToNs(left) > 0 && ToNs(left) <= whole - 95 * kMs, "left: %lld ns",
           (long long)ToNs(left));
    EXPECT(ToNs(left) + passed >= whole - kMs, "left %lld ns after %lld ns", (long long)ToNs(left),
           (long long)passed);

    start = Now();
    AlarmIn(100 * kMs);
    left = {};
    EXPECT(clock_nanosleep(CLOCK_MONOTONIC, 0, &wanted, &left) == EINTR, "clock_nanosleep");
    EXPECT(ToNs(left) > 0 && ToNs(left) <= whole - 95 * kMs, "left: %lld ns",
           (long long)ToNs(left));

    start = Now();
    AlarmIn(100 * kMs);
    const unsigned unslept = sleep(5);
    EXPECT(unslept >= (is_native ? 1u : 4u) && unslept <= 5, "sleep says %u s are left", unslept);

    AlarmIn(100 * kMs);
    EXPECT(usleep(900'000) == -1 && errno == EINTR, "usleep was not interrupted");
    EXPECT(g_handled == before + 4, "%d handlers ran", int(g_handled - before));

    // Where what is left cannot be told, the sleep says that.
    auto* const nowhere = reinterpret_cast<timespec*>(8);
    start = Now();
    AlarmIn(100 * kMs);
    EXPECT(nanosleep(&wanted, nowhere) == -1 && errno == EFAULT, "%s", strerror(errno));
    ExpectSoonAfter(start, 100 * kMs, "a sleep that cannot tell");
    start = Now();
    AlarmIn(100 * kMs);
    const long raw = syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, 0, &wanted, nowhere);
    EXPECT(raw == -1 && errno == EFAULT, "by the system call: %ld, %s", raw, strerror(errno));
    ExpectSoonAfter(start, 100 * kMs, "a system call that cannot tell");
    EXPECT(g_handled == before + 6, "%d handlers ran", int(g_handled - before));
  }

  // An ignored signal ends nothing.
  signal(SIGALRM, SIG_IGN);
  const std::int64_t start = Now();
  AlarmIn(10 * kMs);
  const timespec wanted = ToTimespec(50 * kMs);
  EXPECT(nanosleep(&wanted, nullptr) == 0, "an ignored signal ended a sleep: %s", strerror(errno));
  ExpectSoonAfter(start, 50 * kMs, "a sleep with an ignored signal");
}
