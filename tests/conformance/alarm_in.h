// A SIGALRM later.
#pragma once

#include <sys/time.h>

#include <cstdint>

namespace conformance {

// Once, after `ns`, which is less than a second.
inline void AlarmIn(std::int64_t ns) {
  itimerval timer{};
  timer.it_value.tv_usec = ns / 1000;
  setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace conformance
