// The signals by which people end a run.
#pragma once

#include <signal.h>

namespace tcs {

// SIGTERM, SIGINT and SIGHUP; not SIGHUP where it is ignored, as nohup asks for. A SIGINT that is
// ignored, as in a script's background, still ends a run if somebody sends it. Async-signal-safe.
sigset_t EndSignals();

}  // namespace tcs
