// Abseil's clock and timeouts. Its clock is the cycle counter, which it compares with the kernel's
// now and then.
#include <absl/synchronization/mutex.h>
#include <absl/synchronization/notification.h>
#include <absl/time/clock.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

void ExpectTook(std::int64_t passed, std::int64_t wanted_ns, const char* what) {
  // Where it is measured, a thread's clock may have been ahead, and what is computed is the host's.
  const bool is_measured = g_mode == Mode::kMeasured;
  const std::int64_t slack = wanted_ns / 100 + (is_measured ? kMs / 5 : 0);
  const std::int64_t most = g_mode == Mode::kNative ? kSecond
                            : is_measured           ? slack + 5 * kMs
                                                    : slack;
  EXPECT(passed > wanted_ns - slack && passed < wanted_ns + most, "%s of %lld ms took %lld ns",
         what, (long long)(wanted_ns / kMs), (long long)passed);
}

// Of 10 ms, and of 1 s, after which it may be that it looks at the kernel's clock anew.
void ClocksAgree() {
  for (const int ms : {10, 100, 1000}) {
    for (int i = 0; i < (g_mode == Mode::kNative ? 1 : 5); ++i) {
      const std::int64_t start = Now(), begun = absl::GetCurrentTimeNanos();
      absl::SleepFor(absl::Milliseconds(ms));
      ExpectTook(absl::GetCurrentTimeNanos() - begun, ms * kMs, "by its clock a sleep");
      ExpectTook(Now() - start, ms * kMs, "a sleep");
    }
  }
  const std::int64_t start = Now();
  const absl::Time end = absl::Now() + absl::Milliseconds(20);
  while (absl::Now() < end) continue;
  ExpectTook(Now() - start, 20 * kMs, "a spin");
}

void TimeoutsEndInTime() {
  std::int64_t start = Now();
  absl::Notification never;
  EXPECT(!never.WaitForNotificationWithTimeout(absl::Milliseconds(50)), "notified");
  ExpectTook(Now() - start, 50 * kMs, "a wait for a notification");
  start = Now();
  absl::Mutex mutex;
  absl::CondVar condition;
  mutex.Lock();
  EXPECT(condition.WaitWithTimeout(&mutex, absl::Milliseconds(30)), "signalled");
  mutex.Unlock();
  ExpectTook(Now() - start, 30 * kMs, "a wait for a condition");
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  ClocksAgree();
  TimeoutsEndInTime();
}
