// `tcsim run --gdb ROBOT/CLIENT`: a run, and gdb on one program of it, side by side.
//
//   tcsim ─┬─ the run, in a process of its own, below which everything is as without gdb
//          └─ gdb, which has the terminal until it ends
//
// gdb is no part of the run: it lives in real time, and stays after the run's end until its user
// leaves it.
#pragma once

#include <sys/types.h>

#include <functional>

namespace tcs {

struct GdbSession {
  std::function<void(pid_t)> begin;  // on that process; does not wait for gdb
  std::function<bool()> has_ended;
};

// Calls `run` in a process of its own, and runs gdb once `run` has begun the session. Returns the
// run's exit status when both have ended. gdb's commands come from stdin. Call it before there are
// threads.
int RunWithGdb(const std::function<int(const GdbSession& session)>& run);

}  // namespace tcs
