#include "coordinator/engine/debugger_hold.h"

#include <algorithm>

#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

constexpr char kStoppedByTracer = 't';

}  // namespace

bool DebuggerHold::FindDebuggee() {
  for (const Task& task : run_.table.tasks()) {
    const Process& process = *task.process;
    const bool is_meant = process.spec != nullptr && process.spec->name == run_.options.debugged;
    if (is_meant && task.slot >= 0) debuggee_ = &process;
  }
  if (debuggee_ != nullptr) run_.options.on_debuggee(debuggee_->pid);
  return debuggee_ != nullptr;
}

bool DebuggerHold::HoldsDebuggee() {
  if (debuggee_ == nullptr && !FindDebuggee()) return false;
  if (debuggee_->dead) return false;
  if (!has_come_) {
    has_come_ = TracerOf(debuggee_->pid) != 0 || run_.options.is_debugger_gone();
    return true;
  }
  const auto runs = [this](const Task& task) {
    return task.process == debuggee_ && task.state != TaskState::kDead &&
           ThreadState(task.tid) != kStoppedByTracer;
  };
  return std::none_of(run_.table.tasks().begin(), run_.table.tasks().end(), runs);
}

}  // namespace tcs
