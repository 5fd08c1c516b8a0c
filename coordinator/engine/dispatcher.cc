#include "coordinator/engine/dispatcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "coordinator/calls/call_files.h"
#include "coordinator/engine/turn_plan.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/host/meter.h"
#include "coordinator/host/starvation_watch.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/trap.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/thread_signals.h"
#include "coordinator/port/traps.h"
#include "coordinator/scenario/patience.h"
#include "coordinator/tasks/cpu_clock.h"
#include "coordinator/text/spoken.h"

namespace tcs {

namespace {

// Enough for the kernel to carry out a call that does not wait.
constexpr HostDuration kBrief = HostDuration::Microseconds(20);

// The host decides how far a thread computes after it has created another one, and the two share
// memory.
constexpr HostDuration kBriefCreation = HostDuration::Microseconds(5);

// Where the kernel does not tell whether a thread is still in its call.
constexpr int kMostBriefTurns = 200;

// How often a thread is looked at that has no clock yet.
constexpr HostDuration kLookTurn = HostDuration::Milliseconds(50);
constexpr int kStartTurns = 600;

bool MakesThread(const Task& task) {
  return task.after_call == AfterCall::kCreations &&
         std::all_of(task.creations.begin(), task.creations.end(),
                     [](const Creation& creation) { return creation.call.MakesThread(); });
}

// For how long the coordinator sleeps before its next look at a thread that is to make one call. A
// thread that does not come to that call after some looks waits for others, which these looks keep
// from the processor.
HostDuration BriefSleep(const Task& task, int looks) {
  constexpr int kEager = 8, kMostDoublings = 7;
  const int doublings = std::clamp(looks - kEager, 0, kMostDoublings);
  return (MakesThread(task) ? kBriefCreation : kBrief) * (std::int64_t{1} << doublings);
}

// The computing time that the thread has once it is back from the kernel.
HostDuration BriefTime(const Task& task) { return MakesThread(task) ? HostDuration() : kBrief / 2; }

}  // namespace

// If something has ended the call meanwhile, the thread is on its way, and needs no answer unless
// the kernel makes the call again.
void Dispatcher::AnswerCall(Task& task) {
  const auto answer = [&task] {
    if (!task.trap_file) {
      return AnswerTrapped(task.trap_listener, task.trap_id, task.trap_result);
    }
    const UniqueFd file = std::move(task.trap_file);
    return AnswerTrappedByFile(task.trap_listener, task.trap_id, file.get(),
                               task.trap_file_on_exec);
  };
  task.WasAnswered(task.trap_continues ? all_.guard.Continue(task) : answer());
}

// Changes which thread may run, and opens a gate: with the coordinator blocking next, which is when
// the thread starts, this is the context switch.
void Dispatcher::Resume(Task& task) {
  const bool is_at_gate = task.parked;
  all_.host_cpu.Dispatch(task);
  // A thread that shares the processor runs as soon as it can.
  const bool starts_at_once = !all_.host_cpu.stands_still();
  if (starts_at_once) {
    all_.host_cpu.Start(task, task.spins);
    if (task.slot >= 0) SlotOf(task).clock.horizon_ns = task.grant.horizon_ns;
  }
  if (task.slot < 0 || task.is_adopted) all_.registration.LetRegister(task);
  if (task.trap_id != 0) {
    AnswerCall(task);
  } else if (task.slot >= 0 && is_at_gate) {
    all_.gate_keeper.OpenGate(task);
  }
  // A signal that the thread was sent before is the first thing that it handles.
  if (!run_.is_unprivileged) task.has_signal = false;
  ++run_.report.switches;
  if (!starts_at_once) all_.host_cpu.Start(task, task.spins);
}

void Dispatcher::GoOnBesideWoken() {
  shm::ClockPage& page = SlotOf(*run_.turn.task()).clock;
  const VirtualCpu& cpu = *run_.turn.task()->cpu;
  VirtualTime idle_until;
  const VirtualTime allowed =
      std::max(all_.horizons.Of(*run_.turn.task(), &idle_until), run_.WrittenAt());
  run_.turn.LimitTo(allowed);
  ClockGrant& grant = run_.turn.task()->grant;
  grant.horizon_ns = OwnHorizon().ns();
  grant.idle_until_ns = 0;  // the thread asks
  all_.clock_pages.GrantWhatIsSafe(cpu, grant);
  grant.NoteLimits();
  grant.WriteTo(page);
}

// Real time until the running thread has to be looked at.
HostDuration Dispatcher::TimeToLook(Task& task) {
  if (task.slot < 0) return kLookTurn;
  return all_.host_cpu.TimeToLook(task, OwnHorizon());
}

// The turn's horizon, as the thread's own clock shows it.
ProgramTime Dispatcher::OwnHorizon() const {
  return run_.turn.task()->process->clock.At(run_.turn.horizon());
}

// The thread has a turn for the call that it has made, from when it was there to make it. True once
// the thread must have run, and come back from the kernel: real time that has passed may be the
// host's.
bool Dispatcher::HasMadeCall(Task& task, int* turns) {
  if (task.brief_id == 0 && HostNs(HostClockOf(task)) >= task.brief_until &&
      (ThreadState(task.tid) != 'R' || IsInUserMode(task.tid) || ++*turns > kMostBriefTurns)) {
    task.brief_done = true;
    return true;
  }
  if (task.brief_id != 0 && !HasAnswerToTake(task.trap_listener, task.brief_id)) {
    task.brief_id = 0;
    task.brief_until = HostNs(HostClockOf(task)) + BriefTime(task);
  }
  return false;
}

// The thread has not registered in so many turns. True if the thread is not waited for any more.
bool Dispatcher::GivesUpStart(Task& task, int turns) {
  if (UnregisteredThreads::NeverRegisters(task)) {
    all_.unregistered.Lower(task.tid);
    all_.thread_exit.End(task, {task.reached});
    return true;
  }
  if (turns < kStartTurns) return false;
  run_.report.error = fmt::format(
      "{}, started by {}, did not load the shim within 30 s; check that it is dynamically linked "
      "and not set-uid",
      ProgramOf(task.process->pid), task.process->name);
  return true;
}

// Until the running thread has notified, reached its horizon, or must make room for another one.
void Dispatcher::AwaitStop(Task& task) {
  int starting_turns = 0, brief_turns = 0, brief_looks = 0;
  StarvationWatch starvation(all_.host_cpu.stop_tsc(), all_.clock.rate().ticks_per_ns);
  for (bool first = true;; first = false) {
    // A clock that the thread has changed meanwhile must not be reckoned with.
    if (!first && task.slot >= 0 && !task.HasOwnClock()) return;
    if (!first) all_.host_cpu.Continue(task);
    if (all_.gate_keeper.TakesOpening()) all_.gate_keeper.OpenGate(task);
    const HostDuration asked = task.is_brief ? BriefSleep(task, brief_looks++) : TimeToLook(task);
    if (all_.event_pump.PollWhileRunning(task, asked)) return;
    if (!run_.turn.timed_out) continue;
    run_.turn.timed_out = false;
    if (run_.is_unprivileged) all_.host_cpu.detector().Arm();
    if (all_.debugger.Holds()) {
      Beat();
      continue;
    }
    const std::uint64_t now_tsc = all_.host_cpu.stop_tsc();
    if (!run_.is_unprivileged && starvation.IsDue(now_tsc) &&
        starvation.Starves(now_tsc, HostClockOf(task))) {
      all_.unregistered.LowerThoseThatCompute(all_.home_processor.cpu(),
                                              all_.host_cpu.detector().pid());
    }
    if (task.is_brief) {
      if (HasMadeCall(task, &brief_turns)) return;
      continue;
    }
    if (task.slot < 0) {
      if (GivesUpStart(task, ++starting_turns)) return;
      continue;
    }
    const Meter::Found found = all_.host_cpu.Look(task, OwnHorizon(), CpuClockOf(task));
    if (found == Meter::Found::kIsSilent && !task.process->robot->is_ideal) {
      ChargeSilence(task);
      continue;
    }
    task.spins = found == Meter::Found::kIsSilent;
    if (found != Meter::Found::kGoesOn) {
      run_.turn.timed_out = true;
      return;
    }
  }
}

// Under set costs a thread that spins on what others write to memory would spin for ever, for
// computing takes no time. From now on computing takes time in this client (fixed_meter.h).
void Dispatcher::ChargeSilence(Task& task) {
  Process& client = *task.process->client;
  client.pays_for_silence = task.metered.pays_for_silence = true;
  run_.Warn(fmt::format(
      "{} has computed for {} without a call or an allocation, which costs nothing under "
      "--accounting fixed; from here on each half a millisecond of that, by the processor's "
      "clock, costs it 0.5 ms, and the run may not repeat; run it with --accounting measured",
      client.name, Spoken(PatienceOf(run_.scenario).silent.ns())));
}

// Answers what the thread has said without being dispatched. True if that is all for now.
bool Dispatcher::AnswerEarly(Task& task) {
  if (!task.notified_early && !task.early_trap.has_value()) return false;
  task.parked = true;
  all_.waker.SetState(task, TaskState::kReady);
  const EventTime when{task.reached};
  bool finds_more = false;
  if (std::exchange(task.notified_early, false)) {
    task.reply[0] = task.reply[1] = 0;
    if (!all_.settler.TakeNotesOf(task)) return true;
    finds_more = all_.notification_receiver.Handle(task);
  } else {
    const TrappedCall early = *task.early_trap;
    task.early_trap.reset();
    if (task.slot >= 0) GateKeeper::AnswerBelow(task);
    finds_more = all_.trapped.Handle(task, early);
  }
  if (finds_more) all_.event_pump.Poll(EventPump::kNoWait, when);
  return true;
}

void Dispatcher::BeginTurn(Task& task, VirtualTime horizon, VirtualTime idle_until) {
  Beat();
  task.is_brief = task.after_call != AfterCall::kNone && !task.brief_done;
  // The host decides how far the thread comes in so short a time: under set costs no further than
  // the call.
  if (task.is_brief && run_.IsFixed()) horizon = task.cpu->progress;
  // Other threads may have something to do as soon as the kernel has carried out the thread's call.
  if (task.is_brief || !task.creations.empty()) idle_until = {};
  run_.turn.Begin(task, horizon);
  all_.gate_keeper.TurnBegins();
  if (task.state == TaskState::kHolding) all_.waker.SetState(task, TaskState::kReady);
  if (task.is_beside) {
    if (task.parked) HostCpu::TakeOutWayToGate(task, task.charged, CpuClockOf(task));
    all_.beside.BringHome(task);
  }
  if (task.slot >= 0) {
    TimerSignals::SendTo(task);
    all_.dds.HandOver(task);
    all_.clock_pages.Write(task, horizon, idle_until);
    if (all_.spins.IsToBeAsked(task)) AskWhere(task.process->pid, task.tid);
  }
  if (task.trap_id != 0) task.brief_id = task.trap_id;
  if (task.is_brief) task.brief_until = HostNs(HostClockOf(task)) + BriefTime(task);
  Resume(task);
  run_.turn.recorded_tsc = all_.host_cpu.stop_tsc();
  all_.state_link.Dispatched(task.tid, all_.host_cpu.stop_tsc(), task.cpu->progress.ns());
  NoteTurnBegins(task);
}

void Dispatcher::NoteTurnBegins(Task& task) {
  if (task.activation.start_ns >= 0) return;
  task.activation.start_ns = task.process->clock.At(task.cpu->progress).ns();
}

void Dispatcher::EndTurn(Task& task) {
  all_.host_cpu.active().TakeBack();
  const VirtualTime start = task.cpu->progress;
  if (task.state != TaskState::kDead) all_.settler.Settle(task);
  if (task.state == TaskState::kUnseen) all_.outside.CallBegan(task);
  if (all_.spins.TurnEnds(task, start)) all_.ahead.StayHome(task.process);
  CallFiles::NoteTurn(task);
  all_.undispatched.TurnEnds(task);
  run_.turn.End();
  run_.latest = task.cpu->progress;
  task.used_up = UsedUpAfter(task.used_up, run_.latest, run_.turn.horizon(), run_.turn.HasSpoken());
}

void Dispatcher::TellOthersOf(Task& task, EventTime call, bool looks_again) {
  const EventTime stop{task.cpu->progress};
  all_.timers.ExpireCpu(task);
  if (task.after_call != AfterCall::kNone) all_.after_calls.Do(task, call, looks_again);
  if (!run_.turn.HasSpoken()) all_.spawns.TurnEnds(task, stop);
  task.process->timers.EndRests(stop.at);
  if (run_.turn.HasSpoken()) all_.shared_events.PassOn(task, stop);
  if (!run_.turn.notified && task.slot >= 0) LookForUntoldSignals(task, stop);
}

// The thread cannot say that it has sent a signal before its next dispatch; the receiver must not
// run, at the level of its last dispatch, beside the thread that is next.
void Dispatcher::LookForUntoldSignals(const Task& task, EventTime stop) {
  const std::uint32_t sends = SlotOf(task).signals.load();
  if (sends == 0) return;
  const bool by_library = sends == shm::kSendsByLibrary;
  // The signal is not sent yet: here is the call. Once that call has been here, another one is a
  // handler's.
  const bool calls = run_.turn.trapped.has_value() && SendsSignal(*run_.turn.trapped);
  if (by_library && calls && task.sending.number == 0) return;
  all_.signals.Sent(by_library ? SentBy(run_, task, task.sending) : SentSignal(), stop);
}

void Dispatcher::Answer(Task& task) {
  if (task.state == TaskState::kDead || !run_.turn.HasSpoken()) return;
  const EventTime when{task.reached};
  task.parked = true;
  // The thread was found held by the kernel, and has come back at the same instant.
  if (task.state == TaskState::kUnseen) all_.waker.SetState(task, TaskState::kReady);
  bool finds_more = false;
  if (run_.turn.notified) {
    task.reply[0] = task.reply[1] = 0;
    finds_more = all_.notification_receiver.Handle(task);
  } else {
    finds_more = all_.trapped.Handle(task, *run_.turn.trapped);
  }
  // An event that is there already ends the wait here and now.
  if (finds_more) all_.event_pump.Poll(EventPump::kNoWait, when);
}

void Dispatcher::Dispatch(Task& task, VirtualTime horizon, VirtualTime idle_until) {
  all_.trap_receiver.TakeAgainIfUnmarked(task);
  if (AnswerEarly(task)) return;
  if (all_.kept_calls.WaitsAgain(task)) {
    all_.event_pump.Poll(EventPump::kNoWait, {task.reached});
    return;
  }
  if (run_.is_unprivileged &&
      all_.gate_keeper.BringOthersToGates(task, {task.reached}).stops_running)
    return;
  const bool looks_again = task.brief_done;
  const EventTime call{task.cpu->progress};
  BeginTurn(task, horizon, idle_until);
  AwaitStop(task);
  all_.gate_keeper.BringToGate(task);
  EndTurn(task);
  TellOthersOf(task, call, looks_again);
  if (task.process->violates_protocol) {
    if (task.state != TaskState::kDead) all_.violations.AwaitExit(task);
    return;
  }
  if (task.spins) all_.spinners.StepAside(task);
  Answer(task);
  all_.beside.NoteTurn(task, false);
}

}  // namespace tcs
