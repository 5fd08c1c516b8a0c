// Nobody sets a virtual clock, and nothing disciplines it.
#include <sys/time.h>
#include <sys/timex.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

// Natively these would set the host's clock, or be refused, whoever runs the test.
void Refused() {
  const timespec then = ToTimespec(kSecond);
  EXPECT(clock_settime(CLOCK_REALTIME, &then) == -1 && errno == EPERM, "clock_settime");
  const timeval also_then{1, 0};
  EXPECT(settimeofday(&also_then, nullptr) == -1 && errno == EPERM, "settimeofday");
  const timeval delta{0, 1000};
  EXPECT(adjtime(&delta, nullptr) == -1 && errno == EPERM, "adjtime");
  timeval left{7, 7};
  EXPECT(adjtime(nullptr, &left) == 0 && left.tv_sec == 0 && left.tv_usec == 0, "adjtime reads");
  timex change{};
  change.modes = ADJ_FREQUENCY;
  EXPECT(adjtimex(&change) == -1 && errno == EPERM, "adjtimex");
  EXPECT(ntp_adjtime(&change) == -1 && errno == EPERM, "ntp_adjtime");
  EXPECT(clock_adjtime(CLOCK_REALTIME, &change) == -1 && errno == EPERM, "clock_adjtime");
}

void ExpectNow(const timex& state, std::int64_t before, const char* what) {
  const std::int64_t fraction =
      (state.status & STA_NANO) != 0 ? state.time.tv_usec : state.time.tv_usec * 1000;
  const std::int64_t ns = state.time.tv_sec * kSecond + fraction;
  EXPECT(before / 1000 * 1000 <= ns && ns <= Now(CLOCK_REALTIME), "%s: %lld", what, (long long)ns);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (g_mode != Mode::kNative) Refused();
  timex state{};
  std::int64_t before = Now(CLOCK_REALTIME);
  EXPECT(adjtimex(&state) >= 0, "adjtimex: %s", strerror(errno));
  ExpectNow(state, before, "adjtimex");
  before = Now(CLOCK_REALTIME);
  EXPECT(clock_adjtime(CLOCK_REALTIME, &state) >= 0, "clock_adjtime: %s", strerror(errno));
  ExpectNow(state, before, "clock_adjtime");
  if (g_mode != Mode::kNative) EXPECT(state.freq == 0 && state.offset == 0, "a disciplined clock");
}
