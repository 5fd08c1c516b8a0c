// System calls of clients that the kernel hands over.
#include <sys/syscall.h>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

bool Engine::HandleTrapped(Task& task, const TrappedCall& call) {
  task.trap_id = call.id;
  task.trap_listener = call.listener;
  task.trap_result = 0;
  task.trap_continues = false;
  task.follow_up = FollowUp::kNone;
  task.brief_done = false;
  task.expects_kernel = false;
  bool looks_again = false;
  if (call.number == SYS_futex) {
    HandleFutex(task, call);
  } else {
    looks_again = HandleRawCall(task, call);
  }
  Refresh(*task.process->robot);
  return looks_again;
}

// A trapped call has arrived. That of the running thread stops it like a notification.
Reactor::Found Engine::TrapArrived(int listener, Moment moment) {
  const auto call = ReceiveTrapped(listener);
  if (!call.has_value()) return {.stops_running = !gates_only_, .wakes_others = true};
  const auto take = [this, call](Moment at) { return TakeTrapped(*call, at); };
  Task* by = KnownTask(call->tid);
  if (IsExecution(*call)) {
    if (by != nullptr) by->executes = true;
    LetThrough(*call);
    return {};
  }
  const bool waits = by != nullptr && (by->slot >= 0 || call->number == SYS_futex);
  return waits && PutOff(by, take) ? Reactor::Found{} : take(moment);
}

Reactor::Found Engine::TakeTrapped(const TrappedCall& call, Moment moment) {
  constexpr Reactor::Found kConcernsAll{.stops_running = true, .wakes_others = true};
  Task* task = KnownTask(call.tid);
  // Before it registers a thread is known if it was announced, and others may wait with it for a
  // lock of the C library; what else it calls then is the loader's business.
  const bool ours = task != nullptr && (task->slot >= 0 || call.number == SYS_futex);
  if (!ours) {
    HandleStranger(call, moment);
    return {.stops_running = !gates_only_, .wakes_others = true};
  }
  if (turn_.IsOf(*task)) {
    turn_.trapped = call;
    return kConcernsAll;
  }
  // It ran although it was not dispatched: a signal has ended its call, and the kernel makes it
  // again, or it came back from a call that nobody saw.
  if (task->state == TaskState::kUnseen) MakeReady(*task, shm::WakeReason::kGo, moment);
  if (task->state == TaskState::kWaiting) MakeReady(*task, shm::WakeReason::kSignal, moment);
  ChargeUndispatched(*task);
  task->early_trap = call;
  task->trap_id = 0;
  return kConcernsAll;
}

// The last call of a thread, whichever way it ends: it has no destructors to run any more, and no
// signals to handle.
void Engine::ExitThread(Task& task, const TrappedCall& call) {
  task.trap_id = 0;
  EndTask(task, {task.reached_ns});
  WakeThoseWaitingFor(task, {task.reached_ns});
  ContinueTrapped(call.listener, call.id);
  // Who waits for it looks at a word that the kernel clears.
  if (gates_only_) executor_->LetKernelFinish(call.tid);
}

// A thread that tcs does not know: the C library has made it for itself (asynchronous I/O), or it
// has not registered yet. The kernel carries out what it calls; but those whom it wakes may wait
// here.
void Engine::HandleStranger(const TrappedCall& call, Moment moment) {
  const pid_t pid = call.number == SYS_futex ? ProcessOfThread(call.tid) : -1;
  Process* process = LivingProcess(pid);
  if (process != nullptr && KnownTask(call.tid) == nullptr) {
    process->has_strangers = true;
    CarryOutWake(*process, call, moment);
  }
  LetThrough(call);
}

// At the end of a run the kernel carries out all calls, those that wait included.
void Engine::ReleaseTrapped() {
  for (Task& task : table_.tasks()) {
    if (task.state == TaskState::kDead) continue;
    if (task.trap_id != 0) ContinueTrap(task);
    if (task.early_trap.has_value()) LetThrough(*task.early_trap);
    task.trap_id = 0;
    task.early_trap.reset();
  }
  if (turn_.trapped.has_value()) LetThrough(*turn_.trapped);
  turn_.trapped.reset();
}

}  // namespace tcs
