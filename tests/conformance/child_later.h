// A child process that acts later, while its parent waits for that.
#pragma once

#include <sys/wait.h>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace conformance {

// How much later, unless a test says otherwise.
constexpr std::int64_t kChildDelay = 50 * kMs;

// `child` runs in a child process after the delay; `parent` blocks meanwhile, and goes on at the
// child's virtual time.
template <class Child, class Parent>
void WakesAfterTheDelay(const char* what, Child child, Parent parent) {
  const std::int64_t start = Now();
  const pid_t pid = fork();
  EXPECT(pid >= 0, "fork");
  if (pid == 0) {
    usleep(kChildDelay / 1000);
    NativelyUntil([] { return Sleeps(getppid()); });
    child();
    _exit(0);
  }
  parent();
  const std::int64_t passed = Now() - start;
  EXPECT(passed >= kChildDelay, "%s woke after %lld ns", what, (long long)passed);
  if (g_mode != Mode::kNative) {
    EXPECT(passed < kChildDelay + MostOfChildren(), "%s woke after %lld ns", what,
           (long long)passed);
  }
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "%s: child status %x", what, status);
}

}  // namespace conformance
