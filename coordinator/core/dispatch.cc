// Running one thread up to its horizon, and charging it for what it did.
#include <fmt/format.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "coordinator/calls/call_files.h"
#include "coordinator/calls/ipc_notes.h"
#include "coordinator/core/engine.h"
#include "coordinator/core/turn_plan.h"
#include "coordinator/host/preemption_timer.h"
#include "coordinator/host/settlement.h"
#include "coordinator/host/starvation_watch.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"
#include "coordinator/scenario/patience.h"
#include "coordinator/tasks/cpu_clock.h"
#include "coordinator/text/spoken.h"
#include "shm/clock_page.h"

namespace tcs {

namespace {

// Enough for the kernel to carry out a call that does not wait.
constexpr HostDuration kBrief = HostDuration::Microseconds(20);
// What it computes after the birth of another thread is the host's, and the two share memory.
constexpr HostDuration kBriefBirth = HostDuration::Microseconds(5);
// Where the kernel does not tell whether a thread is still in its call.
constexpr int kMostBriefTurns = 200;
// No program has more charged before it comes to its gate.
constexpr VirtualDuration kMostUndispatched = VirtualDuration::Milliseconds(1);
// How often a thread is looked at that has no clock yet.
constexpr HostDuration kLookTurn = HostDuration::Milliseconds(50);
constexpr int kStartTurns = 600;

bool MakesThread(const Task& task) {
  return task.follow_up == FollowUp::kBirths &&
         std::all_of(task.births.begin(), task.births.end(),
                     [](const Birth& birth) { return birth.call.MakesThread(); });
}

// For how long the coordinator sleeps before its next look at a thread that is to make one call. A
// thread that does not come to it after some looks waits for others, which its looks keep from the
// processor.
HostDuration BriefSleep(const Task& task, int looks) {
  constexpr int kEager = 8, kMostDoublings = 7;
  const int doublings = std::clamp(looks - kEager, 0, kMostDoublings);
  return (MakesThread(task) ? kBriefBirth : kBrief) * (std::int64_t{1} << doublings);
}

// What the thread may compute once it is back from the kernel.
HostDuration AfterCall(const Task& task) { return MakesThread(task) ? HostDuration() : kBrief / 2; }

}  // namespace

// What the thread may do without asking.
void Engine::GrantWhatIsSafe(const VirtualCpu& cpu, ClockGrant& grant) const {
  const bool world_stands = run_.IsCallback();
  grant.read_safe_ns = (world_stands ? cpu.progress : run_.root.ReadSafe(cpu.leaf)).ns();
  grant.local_read_safe_ns = (world_stands ? cpu.progress : run_.root.LocalReadSafe(cpu.leaf)).ns();
  grant.write_safe_ns = run_.root.WriteSafe(cpu.leaf).ns();
}

// What has a set cost and was done on the way to its gate by a thread that ran on undispatched,
// while the kernel held the one whose turn it was (Settle): its next turn begins with that.
std::int64_t Engine::ChargedUndispatched(const Task& task) const {
  if (!run_.IsFixed()) return 0;
  const std::int64_t added_ns =
      shm::AdjustValue(SlotOf(task).clock.executed_adjust.load()) - task.settled_adjust_ns;
  return std::clamp<std::int64_t>(added_ns, 0, kMostUndispatched.ns());
}

void Engine::WritePage(Task& task, VirtualTime horizon, VirtualTime idle_until) {
  CallFiles::LookAtNumbers(task);
  shm::ThreadSlot& slot = SlotOf(task);
  shm::ClockPage& page = slot.clock;
  const VirtualCpu& cpu = *task.cpu;
  const ProgramClock& clock = task.process->clock;
  const ProgramTime now = clock.At(cpu.progress);
  MeteredThread& metered = task.metered;
  if (!metered.has_origin()) metered.host_origin_ns = HostClockOf(task);
  metered.pays_for_silence = task.process->client->pays_for_silence;
  ClockGrant& grant = task.grant;
  grant.base_time_ns = (now + task.debt).ns();
  grant.base_cpu_ns = task.charged.ns();
  grant.horizon_ns = clock.At(horizon).ns();
  grant.idle_until_ns = grant.most_idle_ns = idle_until.ns();
  GrantWhatIsSafe(cpu, grant);
  host_cpu_.SetRates(
      task, {.call = task.process->call_cost, .allocation = task.process->allocation_cost}, grant);
  // Without levels the shim looks at the beginning of each call whether it may begin.
  grant.counts_work = run_.IsFixed() || run_.options.counts_work || run_.gates_only ? 1 : 0;
  if (run_.gates_only && task.trap_id != 0 && task.trap_continues) {
    grant.counts_work |= shm::kBeginsInCall;
  }
  grant.NoteLimits();
  // One that computes on meanwhile goes to its gate rather than read what is half written: it has
  // no horizon before it starts. A reading that has begun is repeated, for there is another number.
  const std::int64_t added_ns = ChargedUndispatched(task);
  ++task.dispatches;
  page.executed_adjust.store(shm::PackAdjust(task.DispatchWord(), added_ns));
  page.waited_adjust.store(task.DispatchWord());
  ClockGrant written = grant;
  if (!host_cpu_.stands_still()) written.horizon_ns = 0;
  written.WriteTo(page);
  page.host_cpu_origin_ns = metered.page_origin_ns = metered.host_origin_ns;
  page.other_cpu_ns = task.process->threads == 1
                          ? task.process->ended.usage().charged_ns
                          : (UsageBook::ChargedTo(*task.process) - task.charged).ns();
  page.children_cpu_ns = task.process->children_cpu.ns();
  const std::int64_t last = page.last_shown_ns.load(std::memory_order_relaxed);
  page.last_shown_ns.store(std::max(last, now.ns()), std::memory_order_relaxed);
  page.last_shown_cpu_ns.store(task.charged.ns(), std::memory_order_relaxed);
  slot.core = cpu.core;
  const VirtualTime end_of_spin = spins_.EndOfSpin(task);
  slot.spin_until_ns = end_of_spin.IsNever() ? shm::kNeverNs : clock.At(end_of_spin).ns();
  slot.reply[0] = task.reply[0];
  slot.reply[1] = task.reply[1];
  slot.wake_reason.store(task.reason);
}

// If something has ended the call meanwhile, the thread is on its way, and needs no answer unless
// the kernel makes the call again.
void Engine::AnswerCall(Task& task) {
  const auto answer = [&task] {
    if (!task.trap_file) {
      return AnswerTrapped(task.trap_listener, task.trap_id, task.trap_result);
    }
    const UniqueFd file = std::move(task.trap_file);
    return AnswerTrappedByFile(task.trap_listener, task.trap_id, file.get(),
                               task.trap_file_on_exec);
  };
  task.WasAnswered(task.trap_continues ? guard_.Continue(task) : answer());
}

// Who may run is changed and a gate opened: with the coordinator blocking next, which is when the
// thread starts, this is the context switch.
void Engine::Resume(Task& task) {
  const bool is_at_gate = task.parked;
  host_cpu_.Dispatch(task);
  // A thread that shares the processor runs as soon as it can.
  const bool starts_at_once = !host_cpu_.stands_still();
  if (starts_at_once) {
    host_cpu_.Start(task, task.spins);
    if (task.slot >= 0) SlotOf(task).clock.horizon_ns = task.grant.horizon_ns;
  }
  if (task.slot < 0 || task.is_adopted) registration_.LetRegister(task);
  if (task.trap_id != 0) {
    AnswerCall(task);
  } else if (task.slot >= 0 && is_at_gate) {
    OpenGate(task);
  }
  // What it was sent before, it handles first of all.
  if (!run_.gates_only) task.has_signal = false;
  ++run_.report.switches;
  if (!starts_at_once) host_cpu_.Start(task, task.spins);
}

// The running thread has woken one of another computer, which does not need its core. It goes on,
// as far as that one now allows.
void Engine::GoOnBesideWoken() {
  shm::ClockPage& page = SlotOf(*run_.turn.task()).clock;
  const VirtualCpu& cpu = *run_.turn.task()->cpu;
  VirtualTime idle_until;
  const VirtualTime allowed =
      std::max(HorizonFor(*run_.turn.task(), &idle_until), run_.WrittenAt());
  run_.turn.LimitTo(allowed);
  ClockGrant& grant = run_.turn.task()->grant;
  grant.horizon_ns = OwnHorizon().ns();
  grant.idle_until_ns = 0;  // it asks
  GrantWhatIsSafe(cpu, grant);
  grant.NoteLimits();
  grant.WriteTo(page);
}

// Real time until the running thread has to be looked at.
HostDuration Engine::TimeToLook(Task& task) {
  if (task.slot < 0) return kLookTurn;
  return host_cpu_.TimeToLook(task, OwnHorizon());
}

// The turn's horizon, as the thread's own clock shows it.
ProgramTime Engine::OwnHorizon() const {
  return run_.turn.task()->process->clock.At(run_.turn.horizon());
}

void Engine::TakeOutUntold(Task& task, const shm::ClockReading& before, HostDuration asked) {
  const HostDuration stolen = host_cpu_.TakeOutUntold(task, before, asked, CpuClockOf(task));
  if (stolen <= HostDuration()) return;
  run_.report.untold_ns += stolen.ns();
  ++run_.report.untold;
}

// False if the thread cannot have done what it has noted: its process is ended for that.
bool Engine::TakeNotesOf(Task& task) {
  const char* what = TakeIpcNotes(task, *memory_, run_.first_realtime_offset_ns.has_value());
  if (what == nullptr) what = datagrams_.TakeNotes(task, task.cpu->progress);
  if (what != nullptr) expulsion_.Expel(*task.process, what);
  return what == nullptr;
}

void Engine::Settle(Task& task) {
  if (task.slot < 0) return;
  // Other threads of its process may write there meanwhile: what is checked is what is reckoned
  // with.
  shm::ThreadSlot& slot = SlotOf(task);
  shm::ClockPage page;
  shm::CopyPage(slot.clock, &page);
  const shm::NotificationKind kind = slot.note.kind;
  const std::int64_t noted_ns = slot.note.time_ns;
  const char* what = slot_check_.WhatIsImpossible(task, page);
  // What it has received before it is told where its activations end; no clock is past the horizon.
  const VirtualTime furthest =
      run_.IsCallback() ? task.cpu->progress : std::max(task.cpu->progress, run_.turn.horizon());
  if (what == nullptr) what = datagrams_.TakeNotes(task, furthest);
  if (what == nullptr) what = posted_.Take(task);
  if (what != nullptr) {
    task.ComeTo(task.cpu->progress);
    expulsion_.Expel(*task.process, what);
    return;
  }
  MeteredThread& metered = task.metered;
  const bool ends = run_.turn.trapped.has_value() && IsEnd(*run_.turn.trapped);
  if (ends) metered.AuditAtEnd();
  host_cpu_.End(task, CpuClockOf(task), &page);
  // What is charged here the thread's own word does not have.
  task.settled_adjust_ns = shm::AdjustValue(page.executed_adjust.load());
  // The shim counts and charges the calls that it sees, whatever the C library calls for it.
  const bool made_unseen_call = run_.turn.trapped.has_value() &&
                                run_.turn.trapped->number != SYS_exit && slot.signals.load() == 0;
  if (made_unseen_call) {
    host_cpu_.ChargeCall(task, task.process->call_cost, &page);
  }
  const shm::ClockReading reading = shm::ReadClockAt(page, host_cpu_.stop_tsc());
  ProgramClock& clock = task.process->clock;
  const auto on_robot = [&clock](std::int64_t own_ns) {
    return clock.RobotTimeOf(OwnTime(own_ns));
  };
  const VirtualTime start = task.cpu->progress;
  // Whom it has woken, however long ago it sent what did, it must not have left behind further than
  // the drift bound: what it has computed beyond is a debt.
  if (!run_.IsCallback()) {
    run_.turn.LimitTo(run_.root.Horizon(task.cpu->leaf));
  }
  StoppedRun run{
      .start = start,
      .horizon = run_.turn.horizon(),
      .reached = on_robot(reading.time_ns),
      .shown = on_robot(shm::ShownTime(page, reading)),
      .most_ours = metered.OnRobot(metered.OnEither(shm::kMostExchangeNs)),
      .is_preempted = run_.turn.timed_out && (!run_.turn.notified || run_.turn.is_sent_to_gate),
      .credit = -task.debt,
      .in_steps = task.metered.is_watched};
  if (run_.turn.notified && kind != shm::NotificationKind::kYield) {
    run.noted = on_robot(noted_ns);
    run.shown = std::max(on_robot(page.last_shown_ns.load()), *run.noted);
  }
  const auto [progress, debt, ours] = SettleRun(run);
  metered.host_origin_ns += metered.OnHost(ours).ns();
  const VirtualDuration charged = std::max(VirtualDuration(), VirtualNs(reading.cpu_ns) - ours);
  const VirtualDuration executed = std::max(VirtualDuration(), charged - task.charged);
  const HostDuration host = metered.OnHost(executed);
  run_.report.client_ns += host.ns();
  task.ran = host;
  metered.longest_run = HostNs(PreemptionTimer::LongestOfLate(metered.longest_run.ns(), host.ns()));
  task.charged = charged;
  task.cpu->busy += executed;
  task.debt = debt;
  activations_.TakeReceipts(task, clock.At(progress));
  task.trapped_calls += made_unseen_call;
  task.work = WithTrapped(task, slot.work);
  if (run_.IsCallback()) {
    // The world stood still meanwhile: only the program's own clock has moved.
    const VirtualDuration computed = progress - start;
    const ProgramTime begun = clock.At(start);
    clock.NoteHeld(start, computed);
    clock.Advance(start, computed);
    task.lead = clock.lead();
    run_.most_lead = std::max(run_.most_lead, task.lead);
    records_.Ran(task, {begun, clock.At(start)}, {start, start}, host_cpu_.stop_tsc());
    TakeNotesOf(task);
    return;
  }
  task.cpu->ComeTo(progress);
  task.ComeTo(progress);
  // Should it run on undispatched, while the kernel holds the one whose turn it is, it comes to its
  // gate when it next looks at its clock: others may have gone on since.
  slot.clock.horizon_ns = task.grant.horizon_ns = 0;
  if (Waker::IsRunnable(task)) waker_.Requeue(task);
  TakeNotesOf(task);
  const bool slept = shm::AdjustValue(reading.waited_word) != 0;
  if (slept) SchedulerOf(task).SleptSince(task.order, progress - start);
  const VirtualTime busy_until = slept ? std::min(progress, start + executed) : progress;
  records_.Ran(task, {clock.At(start), clock.At(busy_until)}, {start, busy_until},
               host_cpu_.stop_tsc());
}

// The thread has a turn for the call that it has made, from when it was there to make it. True once
// it must have run, and come back from the kernel: real time that has passed may be the host's.
bool Engine::HasMadeCall(Task& task, int* turns) {
  if (task.brief_id == 0 && HostNs(HostClockOf(task)) >= task.brief_until &&
      (ThreadState(task.tid) != 'R' || IsInUserMode(task.tid) || ++*turns > kMostBriefTurns)) {
    task.brief_done = true;
    return true;
  }
  if (task.brief_id != 0 && !HasAnswerToTake(task.trap_listener, task.brief_id)) {
    task.brief_id = 0;
    task.brief_until = HostNs(HostClockOf(task)) + AfterCall(task);
  }
  return false;
}

// The thread has not registered in so many turns. True if it is not waited for any more.
bool Engine::GivesUpStart(Task& task, int turns) {
  if (UnmanagedThreads::NeverRegisters(task)) {
    unmanaged_.Lower(task.tid);
    deaths_.End(task, {task.reached});
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
void Engine::AwaitStop(Task& task) {
  int starting_turns = 0, brief_turns = 0, brief_looks = 0;
  StarvationWatch starvation(host_cpu_.stop_tsc(), clock_.rate().ticks_per_ns);
  for (bool first = true;; first = false) {
    // What it has made of its clock meanwhile must not be reckoned with.
    if (!first && task.slot >= 0 && !task.HasOwnClock()) return;
    if (!first) host_cpu_.Continue(task);
    if (std::exchange(opens_gate_, false)) OpenGate(task);
    const HostDuration asked = task.is_brief ? BriefSleep(task, brief_looks++) : TimeToLook(task);
    if (PollWhileRunning(task, asked)) return;
    if (!run_.turn.timed_out) continue;
    run_.turn.timed_out = false;
    if (run_.gates_only) host_cpu_.detector().Arm();
    if (debugger_.Holds()) {
      Beat();
      continue;
    }
    const std::uint64_t now_tsc = host_cpu_.stop_tsc();
    if (!run_.gates_only && starvation.IsDue(now_tsc) &&
        starvation.Starves(now_tsc, HostClockOf(task))) {
      unmanaged_.LowerThoseThatCompute(claim_.cpu, host_cpu_.detector().pid());
    }
    if (task.is_brief) {
      if (HasMadeCall(task, &brief_turns)) return;
      continue;
    }
    if (task.slot < 0) {
      if (GivesUpStart(task, ++starting_turns)) return;
      continue;
    }
    const Meter::Found found = host_cpu_.Look(task, OwnHorizon(), CpuClockOf(task));
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
// computing takes no time. From now on it does, in this client (fixed_meter.h).
void Engine::ChargeSilence(Task& task) {
  Process& client = *task.process->client;
  client.pays_for_silence = task.metered.pays_for_silence = true;
  run_.Warn(fmt::format(
      "{} has computed for {} without a call or an allocation, which costs nothing under "
      "--accounting fixed; from here on each half a millisecond of that, by the processor's "
      "clock, costs it 0.5 ms, and the run may not repeat; run it with --accounting measured",
      client.name, Spoken(PatienceOf(run_.scenario).silent.ns())));
}

// On an ideal robot computing never takes time. The thread waits until somebody has run, and looks
// again, as long as it makes no call.
void Engine::StepAside(Task& task) {
  if (run_.turn.HasSpoken() || task.state == TaskState::kDead) {
    task.spins = false;
    return;
  }
  run_.Warn(fmt::format(
      "{} has computed for {} at one instant of virtual time; its robot is ideal, so the world "
      "waits for it, but no longer than that; from here on it counts as waiting for other programs",
      task.process->name, Spoken(PatienceOf(run_.scenario).ideal.ns())));
  waker_.Wait(task, {awaited::OthersRun{}});
  has_spinners_ = true;
  waker_.Refresh(*task.process->robot);
}

void Engine::WakeSpinners() {
  has_spinners_ = false;
  for (Task& task : run_.table.tasks()) {
    if (task.Awaits<awaited::OthersRun>() != nullptr) {
      waker_.Wake(task, shm::WakeReason::kGo, {run_.latest});
    }
  }
}

// What it has said without being dispatched. True if that is all for now.
bool Engine::AnswerEarly(Task& task) {
  if (!task.notified_early && !task.early_trap.has_value()) return false;
  task.parked = true;
  waker_.SetState(task, TaskState::kReady);
  const Moment moment{task.reached};
  bool finds_more = false;
  if (std::exchange(task.notified_early, false)) {
    task.reply[0] = task.reply[1] = 0;
    if (!TakeNotesOf(task)) return true;
    const shm::Notification early = SlotOf(task).note;
    finds_more = notifications_.Handle(task, early);
  } else {
    const TrappedCall early = *task.early_trap;
    task.early_trap.reset();
    finds_more = trapped_.Handle(task, early);
  }
  if (finds_more) PollEvents(kNoWait, moment);
  return true;
}

void Engine::BeginTurn(Task& task, VirtualTime horizon, VirtualTime idle_until) {
  Beat();
  task.is_brief = task.follow_up != FollowUp::kNone && !task.brief_done;
  // How far it comes in so short a time is the host's: under set costs no further than the call.
  if (task.is_brief && run_.IsFixed()) horizon = task.cpu->progress;
  // Others may have something to do as soon as the kernel has carried its call out.
  if (task.is_brief || !task.births.empty()) idle_until = {};
  run_.turn.Begin(task, horizon);
  says_call_ = opens_gate_ = false;
  if (task.state == TaskState::kHolding) waker_.SetState(task, TaskState::kReady);
  if (task.is_beside) {
    if (task.parked) HostCpu::TakeOutWayToGate(task, task.charged, CpuClockOf(task));
    beside_.BringHome(task);
  }
  if (task.slot >= 0) {
    TimerSignals::SendTo(task);
    dds_.HandOver(task);
    WritePage(task, horizon, idle_until);
    if (spins_.IsToBeAsked(task)) AskWhere(task.process->pid, task.tid);
  }
  if (task.trap_id != 0) task.brief_id = task.trap_id;
  if (task.is_brief) task.brief_until = HostNs(HostClockOf(task)) + AfterCall(task);
  Resume(task);
  run_.turn.recorded_tsc = host_cpu_.stop_tsc();
  state_link_.Dispatched(task.tid, host_cpu_.stop_tsc(), task.cpu->progress.ns());
  NoteTurnBegins(task);
}

void Engine::NoteTurnBegins(Task& task) {
  if (task.activation.start_ns >= 0) return;
  task.activation.start_ns = task.process->clock.At(task.cpu->progress).ns();
}

void Engine::EndTurn(Task& task) {
  host_cpu_.active().TakeBack();
  const VirtualTime start = task.cpu->progress;
  if (task.state != TaskState::kDead) Settle(task);
  if (task.state == TaskState::kUnseen) outside_.CallBegan(task);
  if (spins_.TurnEnds(task, start)) ahead_.StayHome(task.process);
  CallFiles::NoteTurn(task);
  undispatched_.TurnEnds(task);
  run_.turn.End();
  run_.latest = task.cpu->progress;
  task.used_up = UsedUpAfter(task.used_up, run_.latest, run_.turn.horizon(), run_.turn.HasSpoken());
}

// Who is concerned by how the turn has passed, whatever its thread wants now. Its calls were made
// at `call`.
void Engine::TellOthersOf(Task& task, Moment call, bool looks_again) {
  const Moment stop{task.cpu->progress};
  TimerCalls::ExpireCpu(task);
  if (task.follow_up != FollowUp::kNone) follow_ups_.Do(task, call, looks_again);
  if (!run_.turn.HasSpoken()) spawns_.TurnEnds(task, stop);
  task.process->timers.EndRests(stop.at);
  if (run_.turn.HasSpoken()) shared_events_.PassOn(task, stop);
  if (!run_.turn.notified && task.slot >= 0) LookForUntoldSignals(task, stop);
}

// It cannot say that it has sent a signal before its next dispatch; the receiver must not run, at
// the level of its last dispatch, beside whoever is next.
void Engine::LookForUntoldSignals(const Task& task, Moment stop) {
  const std::uint32_t sends = SlotOf(task).signals.load();
  if (sends == 0) return;
  const bool by_library = sends == shm::kSendsByLibrary;
  // Not yet: here is the call. Once that has been here, another one is a handler's.
  const bool calls = run_.turn.trapped.has_value() && SendsSignal(*run_.turn.trapped);
  if (by_library && calls && task.sending.number == 0) return;
  signals_.Sent(by_library ? SentBy(run_, task, task.sending) : SentSignal(), stop);
}

// What the thread has said at the end of its turn.
void Engine::Answer(Task& task) {
  if (task.state == TaskState::kDead || !run_.turn.HasSpoken()) return;
  const Moment moment{task.reached};
  task.parked = true;
  // It was found held by the kernel, and has come back at the same instant.
  if (task.state == TaskState::kUnseen) waker_.SetState(task, TaskState::kReady);
  bool finds_more = false;
  if (run_.turn.notified) {
    task.reply[0] = task.reply[1] = 0;
    const shm::Notification note = SlotOf(task).note;
    finds_more = notifications_.Handle(task, note);
  } else {
    finds_more = trapped_.Handle(task, *run_.turn.trapped);
  }
  // What is there already ends the wait here and now.
  if (finds_more) PollEvents(kNoWait, moment);
}

void Engine::Dispatch(Task& task, VirtualTime horizon, VirtualTime idle_until) {
  TakeAgainIfUnmarked(task);
  if (AnswerEarly(task)) return;
  if (kept_calls_.WaitsAgain(task)) {
    PollEvents(kNoWait, {task.reached});
    return;
  }
  if (run_.gates_only && BringOthersToGates(task, {task.reached}).stops_running) return;
  const bool looks_again = task.brief_done;
  const Moment call{task.cpu->progress};
  BeginTurn(task, horizon, idle_until);
  AwaitStop(task);
  BringToGate(task);
  EndTurn(task);
  TellOthersOf(task, call, looks_again);
  if (task.process->expelled) {
    if (task.state != TaskState::kDead) expulsion_.AwaitDeath(task);
    return;
  }
  if (task.spins) StepAside(task);
  Answer(task);
  beside_.NoteTurn(task, false);
}

}  // namespace tcs
