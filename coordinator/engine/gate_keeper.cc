#include "coordinator/engine/gate_keeper.h"

#include <map>
#include <optional>
#include <utility>

#include "coordinator/engine/wiring.h"
#include "coordinator/os/trap.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/thread_signals.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/cpu_clock.h"
#include "coordinator/tasks/run_clock.h"

namespace tcs {

namespace {

// The processor time that a thread has to handle the signal.
constexpr HostDuration kMostWayToGate = HostDuration::Microseconds(100);

// The same where a signal handler begins that ends a wait: the handler may be the first one since a
// fork, and the memory that it touches on its way be copied page by page, or be in no cache any
// more.
constexpr HostDuration kMostWayFromWait = HostDuration::Milliseconds(1);

// The real time for that: on a busy host others may go first for many slices.
constexpr HostDuration kMostStarved = HostDuration::Seconds(5);
constexpr HostDuration kGateLook = HostDuration::Microseconds(500);
// Between looks at a thread that is at its gate soon.
constexpr HostDuration kShortGateLook = HostDuration::Microseconds(50);
constexpr int kMostAtOnce = 1000;  // events of one instant

// The thread, which is about to go on, sends a signal at once: its shim says so, or the kernel
// carries out the call.
bool SendsSignal(const Task& task) {
  if (task.slot < 0) return false;
  if (task.trap_id == 0) {
    const shm::ThreadSlot& slot = SlotOf(task);
    return slot.signals.load() != 0 && slot.note.kind == shm::NotificationKind::kCall;
  }
  return task.trap_continues && task.trapped_call.id == task.trap_id &&
         SendsSignal(task.trapped_call);
}

// The thread is not dispatched, and has stopped neither at its gate nor in a call that was
// received.
bool MayCompute(const Task& task) {
  const bool has_stopped = task.parked || task.trap_id != 0 || task.early_trap.has_value() ||
                           task.notified_early || task.is_put_off || task.is_call_put_off;
  return task.state != TaskState::kDead && task.slot >= 0 && task.can_be_stopped && !has_stopped &&
         !task.executes && !task.process->violates_protocol;
}

// The thread waits, as it has said, and is awake: it is on its way to sleep at its gate, or a
// handler that it runs will end the wait. Or the kernel has ended the trapped call in which the
// thread waits, though nobody has answered that call: for a signal, whose handler the thread runs.
// Later kernels do so only for signals that end the process (kHoldsSignals in os/trap.cc).
bool IsAwakeInWait(const Task& task) {
  if (task.state != TaskState::kWaiting || task.slot < 0 || task.process->violates_protocol)
    return false;
  const bool may_be =
      task.trap_id == 0 ? task.parked : !HasAnswerToTake(task.trap_listener, task.trap_id);
  return may_be && ThreadState(task.tid) == 'R';
}

}  // namespace

bool GateKeeper::PutOff(const Task* by, Late late) {
  if (!run_.is_unprivileged || (run_.turn.lasts() && by == run_.turn.task())) return false;
  if (!run_.turn.lasts() && put_off_.empty()) return false;  // nothing came before it
  put_off_.push_back(std::move(late));
  return true;
}

PollOutcome GateKeeper::TakePutOff(EventTime when) {
  PollOutcome found;
  for (const Late& late : std::exchange(put_off_, {})) found |= late(when);
  return found;
}

bool GateKeeper::MayGoOn(Task& task) {
  if (run_.turn.is_sent_to_gate) return false;
  const shm::ThreadSlot& slot = SlotOf(task);
  HostCpu::FollowOrigin(task);
  if (slot.note.kind != shm::NotificationKind::kCall) return false;
  says_call_ = true;
  return true;
}

void GateKeeper::OpenGate(Task& task) {
  task.is_let_go = run_.is_unprivileged;
  HostCpu::AllowWay(task);
  HostCpu::OpenGate(SlotOf(task));
}

void GateKeeper::AnswerBelow(Task& task) {
  shm::ThreadSlot& slot = SlotOf(task);
  if (slot.gate.load() == shm::kGateOpen) return;
  ClockPages::WriteAnswer(task);
  HostCpu::OpenGate(slot);
}

// A thread may begin to say that a handler ends its wait, and be dispatched before it has said so.
// The thread does not stop for that, and goes on to what it says next: its note may be about that,
// or about what the handler interrupted. The pipe keeps the order, so that the gate was open
// already if the thread has said nothing else since the gate opened.
bool GateKeeper::IsSaidBeforeTurn(Task& task, const shm::PipeMessage& message) {
  if (message.ends_wait == 0) task.is_let_go = false;
  return task.is_let_go;
}

PollOutcome GateKeeper::EndCall(PollOutcome found) {
  if (!run_.turn.lasts() || !says_call_) return found;
  const EventTime when{run_.WrittenAt()};
  found |= TakePutOff(when);
  while (std::exchange(found.looks_again, false))
    found |= all_.event_pump.LookOnce(EventPump::kNoWait, when, true);
  if (!found.stops_running) found |= BringOthersToGates(*run_.turn.task(), when);
  says_call_ = false;
  if (found.stops_running) {
    Task& task = *run_.turn.task();
    task.parked = true;
    // The thread was found held by the kernel, and has come back at the same instant.
    if (task.state == TaskState::kUnseen) all_.waker.SetState(task, TaskState::kReady);
  } else {
    opens_gate_ = true;
  }
  return found;
}

// The running thread is to stop, and has not said anything: it computes. The thread is told to go
// to its gate, and waited for, so that no other thread runs beside it. Where the thread does not
// come (its program blocks the signal, or the kernel has the thread) it computes on, and owes what
// it computes.
void GateKeeper::BringToGate(Task& task) {
  // Where computing costs nothing, the thread may compute on, unless it pays for that
  // (fixed_meter.h).
  const bool is_charged = run_.Preempts() || (run_.is_unprivileged &&
                                              task.metered.pays_for_silence && run_.turn.timed_out);
  const bool computes = is_charged && task.slot >= 0 && Waker::IsRunnable(task) && !task.parked &&
                        !run_.turn.HasSpoken() && !task.is_brief && task.can_be_stopped &&
                        !task.executes && !task.process->violates_protocol;
  if (!computes || !task.HasOwnClock() || ThreadState(task.tid) != 'R') return;
  const HostDuration sent = HostNs(HostClockOf(task));
  run_.turn.is_sent_to_gate = task.has_signal = true;
  HostCpu::SendToGate(task.process->pid, task);
  const HostTime until = RunClock::Now() + kMostStarved;
  while (RunClock::Now() < until) {
    all_.event_pump.Poll(kGateLook, {});
    if (run_.turn.HasSpoken() || !Waker::IsRunnable(task) || task.process->dead) return;
    if (HostNs(HostClockOf(task)) > sent + kMostWayToGate || ThreadState(task.tid) != 'R') return;
  }
}

// The kernel keeps a signal from a thread in a trapped call once that call has been received.
// Before, the signal's handler would run at once, in the middle of another thread's turn, and the
// call be made again. So no thread may be about to make a call when a thread goes on that sends a
// signal: threads that compute are told to go to their gates, which restarts what they have just
// called, and are waited for as in BringToGate.
PollOutcome GateKeeper::BringOthersToGates(const Task& sender, EventTime when) {
  if (!SendsSignal(sender)) return {};
  const auto computes = [&sender](const Task& task) {
    return &task != &sender && MayCompute(task) && ThreadState(task.tid) == 'R';
  };
  PollOutcome found = AwaitThreads(when, {kGateLook, kMostWayToGate}, computes, [](Task& task) {
    task.has_signal = true;
    HostCpu::SendToGate(task.process->pid, task);
  });
  found |= AwaitSleepAtGates(when);
  for (int turn = 0; turn < kMostAtOnce && all_.reactor.HasMore(); ++turn) {
    found |= all_.event_pump.LookOnce(EventPump::kNoWait, when, true);
  }
  return found;
}

// Before and after a signal is sent. A thread that has said that it waits, and has yet to fall
// asleep, may run the handler at once, as may a thread in a trapped call on kernels that end such
// calls for signals: then no signal is there for the thread any more, and only the thread itself
// can tell that its wait is over. The world must not go on past that.
PollOutcome GateKeeper::AwaitSleepAtGates(EventTime when) {
  return AwaitThreads(when, {kShortGateLook, kMostWayFromWait}, IsAwakeInWait, [](Task&) {});
}

// A thread that was looked at for a signal, and had none, may be running the handler already. No
// thread has a turn before that is known, because the turn might be one long sleep by the thread's
// own clock alone; and no time is jumped over. The sender of the signal makes no difference: a
// program by the shim or past it, or the kernel because a child has ended. A thread that has told
// of its handler sleeps, and has yet to be heard.
void GateKeeper::AwaitHandlers() {
  while (const std::optional<EventTime> look = all_.signal_wakes.TakeLook()) {
    if (!run_.is_unprivileged) return;
    AwaitSleepAtGates(*look);
    all_.event_pump.Poll(EventPump::kNoWait, *look);
  }
}

// All events that come meanwhile happen at `when`. `at_first` is done with each thread once.
PollOutcome GateKeeper::AwaitThreads(EventTime when, const WayToGate& way,
                                     const std::function<bool(const Task&)>& is_awaited,
                                     const std::function<void(Task&)>& at_first) {
  PollOutcome found;
  std::map<const Task*, HostDuration> first_seen;
  bool awaits = true;
  const HostTime until = RunClock::Now() + kMostStarved;
  while (awaits && RunClock::Now() < until) {
    awaits = false;
    for (Task& task : run_.table.tasks()) {
      if (!is_awaited(task)) continue;
      const HostDuration now = HostNs(HostClockOf(task));
      const auto [first, is_new] = first_seen.try_emplace(&task, now);
      if (is_new) at_first(task);
      awaits |= now <= first->second + way.most;
    }
    if (awaits) found |= all_.event_pump.LookOnce(way.look_every, when, true);
  }
  return found;
}

// The time that the thread has computed since its last turn ended, or while it was taken to be
// stopped, is a debt like time that it computes beyond its horizon. Levels let no thread compute
// then, but while the run is held back.
void GateKeeper::ChargeUndispatched(Task& task) {
  const bool may_have_computed = run_.Preempts() || (all_.pacing.IsOn() && !run_.IsFixed());
  if (!may_have_computed || task.slot < 0) return;
  run_.ChargeAsDebt(task, HostCpu::Uncharged(task, task.charged, CpuClockOf(task)));
}

}  // namespace tcs
