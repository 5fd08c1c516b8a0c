#include "coordinator/engine/trap_receiver.h"

#include <sys/syscall.h>

#include <utility>

#include "coordinator/calls/call_files.h"
#include "coordinator/calls/last_descriptor.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/os/trap.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "shm/check.h"

namespace tcs {

namespace {

// A child that has its parent's memory and place (spawns.h) sleeps in its parent's time. All other
// calls are the child's own.
bool IsSleep(const TrappedCall& call) {
  return call.number == SYS_nanosleep || call.number == SYS_clock_nanosleep;
}

// True if the kernel has the thread make the call again in which the thread waits for its answer,
// as it is: the thread was frozen meanwhile with its container or the machine, say, or a tracer has
// looked at it. Not so a call that a signal was to end: that call has ended, and this is the next
// one.
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
// its process handles the signal. The thread's call is taken as one that the thread makes again, as
// the kernel would have it. So no thread but one that is marked for a signal is answered that a
// signal has ended its call, and the kernel shows no program that number.
void TrapReceiver::TakeAgainIfUnmarked(Task& task) {
  if (task.trap_id == 0 || task.trap_continues || !EndsBySignal(task.trap_result)) return;
  if (task.slot >= 0) TimerSignals::SendTo(task);  // the signal may be one of these
  if (IsMarkedForSignal(task.tid) || !HasAnswerToTake(task.trap_listener, task.trap_id)) return;
  TCS_CHECK(task.unanswered_call.id == task.trap_id);
  task.early_trap = task.unanswered_call;
  task.trap_id = 0;
}

// The thread that made the call; null: none that is known.
Task* TrapReceiver::TaskOf(const TrappedCall& call) {
  Task* task = run_.table.Living(call.tid);
  return task == nullptr && IsSleep(call) ? all_.spawns.ActsFor(call.tid) : task;
}

PollOutcome TrapReceiver::Arrived(int listener, EventTime when) {
  const auto call = ReceiveTrapped(listener);
  if (!call.has_value()) return {.stops_running = !run_.is_unprivileged, .wakes_others = true};
  if (LastDescriptor::AsksFor(*call)) {
    LastDescriptor::Answer(run_, run_.table.Living(call->tid), *call);
    return {};
  }
  if (CallFiles::AsksFor(*call)) {
    CallFiles::Answer(run_.table.Living(call->tid), *call);
    return {};
  }
  // Most files are the kernel's to open, and do not concern the coordinator.
  if (ComputerFiles::IsOpen(*call) && !ComputerFiles::IsOfComputer(*call)) {
    all_.guard.LetThrough(*call);
    return {};
  }
  const auto take = [this, call](EventTime at) { return Take(*call, at); };
  Task* by = run_.table.Living(call->tid);
  if (by != nullptr && by->turns_beside) return take(when);
  if (IsExecution(*call) || IsEnd(*call)) {
    if (by != nullptr) by->executes = IsExecution(*call);
    // A child that the thread has made is not its child any more afterwards, or not in its place.
    if (by != nullptr) all_.spawns.MakerSpeaks(*by, when);
    // No other process may have the process's descriptors when they are closed.
    Process* process = run_.table.LivingProcess(ProcessOfThread(call->tid));
    if (process != nullptr && process->broker != nullptr) process->broker->End();
    all_.guard.LetThrough(*call);
    return {};
  }
  if (BeginsProgram(*call)) {
    all_.bare_programs.Begins(ProcessOfThread(call->tid));
    all_.ros_daemon.Begins(ProcessOfThread(call->tid));
    all_.guard.LetThrough(*call);
    return {};
  }
  if (all_.sockets.ConnectBy(*call)) return {};
  if (MakesTask(*call) && by != nullptr && run_.turn.IsOf(*by) && Spawns::IsAnnounced(*by)) {
    Spawns::Begin(*by, *call);
    all_.guard.LetThrough(*call);
    return {};
  }
  const bool has_place = by != nullptr && (by->slot >= 0 || !by->process->is_bare);
  if (!has_place) by = all_.registration.Adopt(call->tid, when);
  if (by == nullptr && all_.spawns.IsUnborn(call->tid, when)) {
    unborn_calls_.push_back(*call);
    return {};
  }
  if (by == nullptr) by = TaskOf(*call);
  const bool waits = by != nullptr && (by->slot >= 0 || call->number == SYS_futex);
  if (!waits || !all_.gate_keeper.PutOff(by, take)) return take(when);
  by->is_call_put_off = true;
  return {};
}

void TrapReceiver::TakeCallsOfNewborns(EventTime when) {
  for (const TrappedCall& call : std::exchange(unborn_calls_, {})) {
    if (all_.spawns.IsUnborn(call.tid, when)) {
      unborn_calls_.push_back(call);
    } else {
      Take(call, when);
    }
  }
}

PollOutcome TrapReceiver::Take(const TrappedCall& call, EventTime when) {
  Task* task = TaskOf(call);
  if (task != nullptr) task->is_call_put_off = false;
  // Before a thread registers it is known if it was announced, and others may wait with it for a
  // lock of the C library; any other call of the thread is the loader's business then.
  const bool ours = task != nullptr && (task->slot >= 0 || call.number == SYS_futex);
  if (!ours) {
    all_.trapped.HandleUnregistered(call, when);
    return {.stops_running = !run_.is_unprivileged, .wakes_others = true};
  }
  if (MakesCallAgain(*task, call)) {
    if (run_.turn.IsOf(*task)) all_.dispatcher.AnswerCall(*task);
    return {};
  }
  all_.ahead.HasSpoken(*task);
  if (run_.turn.IsOf(*task)) {
    run_.turn.trapped = call;
    return kConcernsAll;
  }
  // The thread ran although it was not dispatched: a signal has ended its call, and the kernel
  // makes the call again, or the thread came back from a call that nobody saw.
  if (task->state == TaskState::kUnseen) all_.unseen_threads.ComeBack(*task, when);
  if (task->state == TaskState::kWaiting) all_.waker.Wake(*task, shm::WakeReason::kSignal, when);
  // The thread's work in a turn beside others is charged when that turn has its order.
  if (!task->turns_beside) all_.gate_keeper.ChargeUndispatched(*task);
  task->early_trap = call;
  task->trap_id = 0;
  return kConcernsAll;
}

}  // namespace tcs
