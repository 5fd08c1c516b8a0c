// System calls of clients that the kernel hands over.
#include <sys/syscall.h>

#include <utility>

#include "coordinator/calls/call_files.h"
#include "coordinator/calls/last_descriptor.h"
#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "shm/check.h"

namespace tcs {

namespace {

// What a child that has its parent's memory and place (spawns.h) does to time, it does to the
// parent's. All else is the child's own.
bool IsSleep(const TrappedCall& call) {
  return call.number == SYS_nanosleep || call.number == SYS_clock_nanosleep;
}

// The kernel has the thread make the call again in which it waits for its answer, as it is: the
// thread was frozen meanwhile with its container or the machine, say, or a tracer has looked at it.
// Not so a call that a signal was to end: that has ended, and this is the next one.
bool MakesCallAgain(Task& task, const TrappedCall& call) {
  const bool is_over =
      task.trap_id != 0 && !task.wait.has_value() && EndsBySignal(task.trap_result);
  const bool waits = (task.trap_id != 0 || task.answer_lost) && !is_over;
  if (!waits || task.state == TaskState::kUnseen || !call.IsAgain(task.unanswered_call)) {
    return false;
  }
  const std::uint64_t before = task.unanswered_call.id;
  if (task.trapped_call.id == before) task.trapped_call.id = call.id;
  if (task.brief_id == before) task.brief_id = call.id;
  task.trap_id = task.unanswered_call.id = call.id;
  task.answer_lost = false;
  return true;
}

}  // namespace

// A signal was to end the thread's wait, but the kernel has none for the thread: another thread of
// its process handles it. The thread's call is taken as one that it makes again, as the kernel
// would have it. So no thread but one that is marked for a signal is answered that a signal has
// ended its call, and the kernel shows no program that number.
void Engine::TakeAgainIfUnmarked(Task& task) {
  if (task.trap_id == 0 || task.trap_continues || !EndsBySignal(task.trap_result)) return;
  if (task.slot >= 0) TimerSignals::SendTo(task);  // it may be one of these
  if (IsMarkedForSignal(task.tid) || !HasAnswerToTake(task.trap_listener, task.trap_id)) return;
  TCS_CHECK(task.unanswered_call.id == task.trap_id);
  task.early_trap = task.unanswered_call;
  task.trap_id = 0;
}

// Null: nobody's who is known.
Task* Engine::TaskOf(const TrappedCall& call) {
  Task* task = run_.table.Living(call.tid);
  return task == nullptr && IsSleep(call) ? spawns_.ActsFor(call.tid) : task;
}

// A trapped call has arrived. That of the running thread stops it like a notification.
Reactor::Found Engine::TrapArrived(int listener, Moment moment) {
  const auto call = ReceiveTrapped(listener);
  if (!call.has_value()) return {.stops_running = !run_.gates_only, .wakes_others = true};
  if (LastDescriptor::AsksFor(*call)) {
    LastDescriptor::Answer(run_, run_.table.Living(call->tid), *call);
    return {};
  }
  if (CallFiles::AsksFor(*call)) {
    CallFiles::Answer(run_.table.Living(call->tid), *call);
    return {};
  }
  // Most files are the kernel's to open, and nobody's business here.
  if (ComputerFiles::IsOpen(*call) && !ComputerFiles::IsOfComputer(*call)) {
    guard_.LetThrough(*call);
    return {};
  }
  const auto take = [this, call](Moment at) { return TakeTrapped(*call, at); };
  Task* by = run_.table.Living(call->tid);
  if (by != nullptr && by->turns_beside) return take(moment);
  if (IsExecution(*call) || IsEnd(*call)) {
    if (by != nullptr) by->executes = IsExecution(*call);
    // What it has made is not its child any more afterwards, or not in its place.
    if (by != nullptr) spawns_.MakerSpeaks(*by, moment);
    // Nobody else may have the process's descriptors when they are closed.
    Process* process = run_.table.LivingProcess(ProcessOfThread(call->tid));
    if (process != nullptr && process->porter != nullptr) process->porter->End();
    guard_.LetThrough(*call);
    return {};
  }
  if (BeginsProgram(*call)) {
    bare_programs_.Begins(ProcessOfThread(call->tid));
    ros_daemon_.Begins(ProcessOfThread(call->tid));
    guard_.LetThrough(*call);
    return {};
  }
  if (sockets_.ConnectBy(*call)) return {};
  if (MakesTask(*call) && by != nullptr && run_.turn.IsOf(*by) && Spawns::IsAnnounced(*by)) {
    Spawns::Begin(*by, *call);
    guard_.LetThrough(*call);
    return {};
  }
  const bool has_place = by != nullptr && (by->slot >= 0 || !by->process->is_bare);
  if (!has_place) by = registration_.Adopt(call->tid, moment);
  if (by == nullptr && spawns_.IsUnborn(call->tid, moment)) {
    unborn_calls_.push_back(*call);
    return {};
  }
  if (by == nullptr) by = TaskOf(*call);
  const bool waits = by != nullptr && (by->slot >= 0 || call->number == SYS_futex);
  if (!waits || !PutOff(by, take)) return take(moment);
  by->is_call_put_off = true;
  return {};
}

// Their makers have gone on, so that it is known whose they are.
void Engine::TakeCallsOfNewborns(Moment moment) {
  for (const TrappedCall& call : std::exchange(unborn_calls_, {})) {
    if (spawns_.IsUnborn(call.tid, moment)) {
      unborn_calls_.push_back(call);
    } else {
      TakeTrapped(call, moment);
    }
  }
}

Reactor::Found Engine::TakeTrapped(const TrappedCall& call, Moment moment) {
  Task* task = TaskOf(call);
  if (task != nullptr) task->is_call_put_off = false;
  // Before it registers a thread is known if it was announced, and others may wait with it for a
  // lock of the C library; what else it calls then is the loader's business.
  const bool ours = task != nullptr && (task->slot >= 0 || call.number == SYS_futex);
  if (!ours) {
    trapped_.HandleUnmanaged(call, moment);
    return {.stops_running = !run_.gates_only, .wakes_others = true};
  }
  if (MakesCallAgain(*task, call)) {
    if (run_.turn.IsOf(*task)) AnswerCall(*task);
    return {};
  }
  ahead_.HasSpoken(*task);
  if (run_.turn.IsOf(*task)) {
    run_.turn.trapped = call;
    return kConcernsAll;
  }
  // It ran although it was not dispatched: a signal has ended its call, and the kernel makes it
  // again, or it came back from a call that nobody saw.
  if (task->state == TaskState::kUnseen) ComeBack(*task, moment);
  if (task->state == TaskState::kWaiting) waker_.Wake(*task, shm::WakeReason::kSignal, moment);
  // What it has done in a turn beside others is charged when that has its order.
  if (!task->turns_beside) ChargeUndispatched(*task);
  task->early_trap = call;
  task->trap_id = 0;
  return kConcernsAll;
}

}  // namespace tcs
