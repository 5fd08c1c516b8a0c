// Nobody sets a virtual clock, and nothing disciplines it.
#include <dlfcn.h>
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
  auto* stime = reinterpret_cast<int (*)(const time_t*)>(dlsym(RTLD_DEFAULT, "stime"));
  EXPECT(stime != nullptr && stime(&then.tv_sec) == -1 && errno == EPERM, "stime");
  timex change{};
  change.modes = ADJ_FREQUENCY;
  EXPECT(adjtimex(&change) == -1 && errno == EPERM, "adjtimex");
  EXPECT(ntp_adjtime(&change) == -1 && errno == EPERM, "ntp_adjtime");
  EXPECT(clock_adjtime(CLOCK_REALTIME, &change) == -1 && errno == EPERM, "clock_adjtime");
}

template <class State>
void ExpectNow(const State& state, bool in_ns, std::int64_t before, const char* what) {
  const std::int64_t fraction = state.time.tv_usec * (in_ns ? 1 : 1000);
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
  ExpectNow(state, (state.status & STA_NANO) != 0, before, "adjtimex");
  before = Now(CLOCK_REALTIME);
  EXPECT(clock_adjtime(CLOCK_REALTIME, &state) >= 0, "clock_adjtime: %s", strerror(errno));
  ExpectNow(state, (state.status & STA_NANO) != 0, before, "clock_adjtime");
  const bool in_ns = (state.status & STA_NANO) != 0;
  ntptimeval time{};
  before = Now(CLOCK_REALTIME);
  EXPECT(ntp_gettimex(&time) >= 0, "ntp_gettimex: %s", strerror(errno));
  ExpectNow(time, in_ns, before, "ntp_gettimex");
  EXPECT(ntp_gettime(&time) >= 0, "ntp_gettime: %s", strerror(errno));
  ExpectNow(time, in_ns, before, "ntp_gettime");
  auto* old = reinterpret_cast<int (*)(ntptimeval*)>(dlsym(RTLD_DEFAULT, "ntp_gettime"));
  EXPECT(old != nullptr && old(&time) >= 0, "ntp_gettime");
  ExpectNow(time, in_ns, before, "ntp_gettime, the function of this name");
  timex again{};
  auto* twin = reinterpret_cast<int (*)(timex*)>(dlsym(RTLD_DEFAULT, "__adjtimex"));
  EXPECT(twin != nullptr && twin(&again) >= 0, "__adjtimex");
  ExpectNow(again, in_ns, before, "__adjtimex");
  timespec resolution{};
  EXPECT(timespec_getres(&resolution, TIME_UTC) == TIME_UTC && ToNs(resolution) > 0, "getres");
  EXPECT(timespec_getres(&resolution, 99) == 0, "an unknown base");
  if (g_mode != Mode::kNative) EXPECT(state.freq == 0 && state.offset == 0, "a disciplined clock");
}
