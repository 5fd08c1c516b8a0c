#include "coordinator/calls/trapped_calls.h"

#include <sys/syscall.h>

#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"

namespace tcs {

bool TrappedCalls::Handle(Task& task, const TrappedCall& call) {
  task.trap_id = call.id;
  task.unanswered_call = call;
  task.answer_lost = false;
  task.trap_listener = call.listener;
  task.trap_result = 0;
  task.trap_continues = false;
  task.after_call = AfterCall::kNone;
  task.brief_done = false;
  task.expects_kernel = task.in_vfork = false;
  spawns_.MakerSpeaks(task, {task.reached});
  bool looks_again = false;
  if (call.number == SYS_futex) {
    futexes_.Handle(task, call);
  } else {
    looks_again = syscalls_.Handle(task, call);
  }
  if (task.slot >= 0) {
    SlotOf(task).waits_in_call.store(task.state == TaskState::kWaiting ? 1 : 0);
  }
  waker_.Refresh(*task.process->robot);
  return looks_again;
}

// A thread that tcs does not know: the C library has made it for itself (asynchronous I/O), or it
// has not registered yet. The kernel carries out what the thread calls; but the threads that it
// wakes may wait here.
void TrappedCalls::HandleUnregistered(const TrappedCall& call, EventTime when) {
  const bool concerns_others = call.number == SYS_futex || call.number == SYS_bind;
  const pid_t pid = concerns_others ? ProcessOfThread(call.tid) : -1;
  Process* process = run_.table.LivingProcess(pid);
  if (call.number == SYS_futex && process != nullptr && run_.table.Living(call.tid) == nullptr) {
    process->has_unregistered_threads = run_.had_unregistered_threads = true;
    futexes_.CarryOutWake(*process, call, when);
  }
  if (call.number == SYS_bind) {
    local_sockets_.BindsUnseen(process == nullptr ? nullptr : process->robot, call);
  }
  guard_.LetThrough(call);
}

// The last call of a thread, whichever way it ends: the thread has no destructors to run any more,
// and no signals to handle.
void TrappedCalls::Exit(Task& task, const TrappedCall& call) {
  task.trap_id = 0;
  thread_exit_.EndAndWake(task, {task.reached});
  ContinueTrapped(call.listener, call.id);
  // A thread that joins this one looks at a word that the kernel clears. Were the kernel not
  // through with this one, the coordinator would have to sleep for that, and threads would run
  // whose turn it is not.
  executor_.LetKernelFinish(call.tid);
  if (IsExiting(call.tid)) run_.exiting.push_back(call.tid);
}

void TrappedCalls::ReleaseAll() {
  for (Task& task : run_.table.tasks()) {
    if (task.state == TaskState::kDead) continue;
    if (task.trap_id != 0) guard_.Continue(task);
    if (task.early_trap.has_value()) guard_.LetThrough(*task.early_trap);
    task.trap_id = 0;
    task.early_trap.reset();
  }
  if (run_.turn.trapped.has_value()) guard_.LetThrough(*run_.turn.trapped);
  run_.turn.trapped.reset();
}

}  // namespace tcs
