// What every conformance program shares. The program knows nothing of tcs but for its one argument,
// which says what exactness to expect: none when run natively, "measured" or "fixed" under tcsim.
#pragma once

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <initializer_list>

namespace conformance {

enum class Mode { kNative, kMeasured, kFixed };
inline Mode g_mode = Mode::kNative;

constexpr std::int64_t kMs = 1'000'000, kSecond = 1'000'000'000;
// What an intercepted call costs under `tcsim exec --accounting fixed`.
constexpr std::int64_t kCallNs = 1'000;

__attribute__((format(printf, 1, 2))) [[noreturn]] inline void Fail(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vfprintf(stderr, format, arguments);
  va_end(arguments);
  fputc('\n', stderr);
  _exit(1);
}

#define EXPECT(condition, ...)                                                      \
  do {                                                                              \
    if (!(condition)) {                                                             \
      fprintf(stderr, "%s:%d: %s does not hold: ", __FILE__, __LINE__, #condition); \
      conformance::Fail(__VA_ARGS__);                                               \
    }                                                                               \
  } while (false)

inline std::int64_t ToNs(const timespec& t) { return t.tv_sec * kSecond + t.tv_nsec; }
inline timespec ToTimespec(std::int64_t ns) { return {ns / kSecond, ns % kSecond}; }

inline std::int64_t Now(clockid_t clock = CLOCK_MONOTONIC) {
  timespec t;
  EXPECT(clock_gettime(clock, &t) == 0, "clock %d: %s", clock, strerror(errno));
  return ToNs(t);
}

// From `start` to now something was waited for that ends `wanted_ns` after `start`. Never early
// (natively the kernel counts the timeouts of sockets in its ticks, and may be early by one); under
// tcs not late by more than what was computed; with set costs late by exactly `calls` calls,
// the one that asks for the time now included.
inline void ExpectWaited(std::int64_t start, std::int64_t wanted_ns, int calls, const char* what) {
  const std::int64_t passed = Now() - start;
  const std::int64_t tick_ns = g_mode == Mode::kNative ? 10 * kMs : 0;
  EXPECT(passed >= wanted_ns - tick_ns, "%s took %lld ns, which is early", what, (long long)passed);
  if (g_mode == Mode::kMeasured) {
    EXPECT(passed < wanted_ns + 5 * kMs, "%s took %lld ns", what, (long long)passed);
  }
  if (g_mode == Mode::kFixed) {
    EXPECT(passed == wanted_ns + calls * kCallNs, "%s took %lld ns", what, (long long)passed);
  }
}

// The most that a child's start costs it and its parent, and its end. Where it is measured that is
// the host's: 2 ms on an idle one, 12 were seen on a busy one.
inline std::int64_t MostOfChildren() { return (g_mode == Mode::kMeasured ? 50 : 10) * kMs; }

// The same where nobody counts the calls on the way, a child's start among them: under tcs late by
// less than `slack_ns`.
inline void ExpectSoonAfter(std::int64_t start, std::int64_t wanted_ns, const char* what,
                            std::int64_t slack_ns = MostOfChildren()) {
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= wanted_ns, "%s took %lld ns, which is early", what, (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < wanted_ns + slack_ns, "%s took %lld ns", what, (long long)passed);
  }
}

// The same where several threads make calls on the way, a few dozen at most, or compute, each up to
// its turn's end. Where it is measured late by less than `measured_slack_ns`.
inline void ExpectPassed(std::int64_t start, std::int64_t wanted_ns, const char* what,
                         std::int64_t measured_slack_ns = 10 * kMs) {
  ExpectSoonAfter(start, wanted_ns, what,
                  g_mode == Mode::kFixed ? 60 * kCallNs : measured_slack_ns);
}

// Sets the mode, and proves that the shim engaged: an hour passes at once, or the test runs into
// its time limit.
inline void Begin(int argc, char** argv) {
  if (argc < 2) return;
  g_mode = strcmp(argv[1], "fixed") == 0 ? Mode::kFixed : Mode::kMeasured;
  const std::int64_t start = Now();
  sleep(3600);
  ExpectWaited(start, 3600 * kSecond, 2, "an hour's sleep");
}

}  // namespace conformance
