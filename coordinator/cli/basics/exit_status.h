// The exit statuses of tcsim itself; `exec` otherwise passes on its program's own status.
#pragma once

#include <string>

#include "coordinator/os/say.h"

namespace tcs {

inline constexpr int kSucceeded = 0;
inline constexpr int kClientFailed = 1;  // the run went to its end, but a client of it failed
inline constexpr int kCannotRun = 2;     // nothing was run, or not to its end
inline constexpr int kExpectationFailed =
    3;                                      // something is worse than it may be, or not as expected
inline constexpr int kNoSuchProgram = 127;  // as a shell says it
// Ended by a signal, in order, as a shell says it: 130 by ^C, 143 by SIGTERM, 129 by SIGHUP.
inline int InterruptedBy(int signal) { return 128 + signal; }

// The one clear sentence of a failure.
inline int Fail(const std::string& sentence, int status = kCannotRun) {
  Say(sentence);
  return status;
}

}  // namespace tcs
