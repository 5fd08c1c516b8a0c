// A client that its user debugs (tcsim run --gdb): the client does not begin before the debugger is
// there, and while the debugger has stopped the client the whole run stands still, in virtual time.
//
// For the coordinator's thread only. Reads /proc; costs nothing where no client is debugged.
#pragma once

#include "coordinator/tasks/run_state.h"

namespace tcs {

class DebuggerHold {
 public:
  explicit DebuggerHold(const RunState& run) : run_(run) {}

  bool IsOf(const Process& process) const {
    return &process == debuggee_ && !run_.options.debugged.empty();
  }

  // True while no thread may go on: the client has registered and its debugger, which is asked for
  // once, has not come; or the debugger has stopped all threads of the client. False also once the
  // client has ended.
  bool Holds() { return !run_.options.debugged.empty() && HoldsDebuggee(); }

 private:
  bool HoldsDebuggee();
  bool FindDebuggee();

  const RunState& run_;
  const Process* debuggee_ = nullptr;  // once the client has registered
  bool has_come_ = false;              // the debugger has come; or it will not
};

}  // namespace tcs
