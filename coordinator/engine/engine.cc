// The loop: advance the dynamics, choose the least advanced virtual CPU, let it act.
#include "coordinator/core/engine.h"

#include <fmt/format.h>
#include <time.h>
#include <x86gprintrin.h>

#include <algorithm>
#include <utility>

#include "coordinator/core/turn_plan.h"
#include "coordinator/gateway/gateway_robot.h"
#include "coordinator/host/fifo_executor.h"
#include "coordinator/host/gate_executor.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"
#include "coordinator/os/open_file_limit.h"
#include "coordinator/os/own_computer.h"
#include "coordinator/scenario/patience.h"
#include "coordinator/text/spoken.h"
#include "shm/check.h"

namespace tcs {

namespace {

constexpr HostDuration kUnseenPoll = HostDuration::Milliseconds(1);
constexpr HostDuration kDebuggerPoll = HostDuration::Milliseconds(10);
constexpr HostDuration kOutsidePoll = HostDuration::Milliseconds(200);
constexpr int kDeathTurns = 25;  // of kOutsidePoll
constexpr std::int64_t kLookEveryNs = 200'000'000;
constexpr std::uint64_t kLookPause = 50;  // times what the last look took, at the least
constexpr int kShowsPerFlush = 5;

std::unique_ptr<Executor> MakeExecutor(bool gates_only) {
  if (gates_only) return std::make_unique<GateExecutor>();
  return std::make_unique<FifoExecutor>();
}

}  // namespace

Engine::Engine(const Scenario& scenario, const RunOptions& options)
    : real_time_(AskForRealTime()),
      run_(scenario, options, real_time_.error != 0, WhyNoDuplicates() != 0),
      activations_(run_.IsCallback()),
      executor_(MakeExecutor(run_.gates_only)),
      host_cpu_(*executor_, PatienceOf(scenario).ideal) {
  TellOfWaits();
  TellOfEnds();
}

Engine::~Engine() = default;

// `idle_until`: the thread may sleep that far without asking, for nothing else happens here before.
VirtualTime Engine::HorizonFor(Task& task, VirtualTime* idle_until) {
  const VirtualCpu& cpu = *task.cpu;
  const Robot& robot = *cpu.robot;
  *idle_until = {};
  const VirtualTime seen_by_spinners = spins_.LimitOf(task);
  task.metered.is_watched = !seen_by_spinners.IsNever() && !run_.gates_only;
  if (run_.IsCallback()) {
    return std::min({FurthestOf(cpu.progress),
                     robot.scheduler.HorizonWhileWorldStands(cpu.core, task.order),
                     cpu.progress + LeftToHold(task)});
  }
  const ProcessTimers& timers = task.process->timers;
  TurnLimits limits{.start = cpu.progress,
                    .apart = std::min(run_.root.Horizon(cpu.leaf), seen_by_spinners),
                    .cpu_time = {},
                    .next_launch = robot.next_launch,
                    .next_timer_look = timers.NextLook()};
  if (timers.HasCpuTimers()) limits.cpu_time = timers.CpuTimeToExpiry(TimerCalls::CpuUsedBy(task));
  const VirtualTime limit = LimitOf(limits);
  const RobotScheduler::Horizon horizon =
      robot.scheduler.HorizonOf(cpu.core, task.order, limit,
                                {.input = run_.root.NextInput(cpu.leaf),
                                 .outside_input = run_.root.NextInputFromOutside(cpu.leaf),
                                 .output = run_.root.NextOutput(),
                                 .acts_at_once = run_.IsFixed() || robot.is_ideal,
                                 .has_given_way = run_.root.HasGivenWay(cpu.leaf)});
  *idle_until = horizon.idle;
  return horizon.run;
}

// A program that computes for as long as the run is to be, all at one instant of the world's, would
// have the world stand for ever. Short runs, too, may have long plans computed.
VirtualDuration Engine::MostHeld() const {
  return run_.IsInGrace() ? Patience{}.held : PatienceOf(run_.scenario).held;
}

VirtualDuration Engine::LeftToHold(const Task& task) const {
  const VirtualDuration held = task.process->clock.HeldAt(task.cpu->progress);
  return std::clamp(MostHeld() - held, VirtualDuration(), VirtualNs(shm::kMaxDispatchNs));
}

// The virtual CPU of an ideal robot has been at this instant for long, of real time, though its
// threads stop and go on: they may be answering each other for ever.
bool Engine::StandsForEver(VirtualCpu& cpu) const {
  const HostTime now = RunningTime();
  if (std::exchange(cpu.stands_at, cpu.progress) != cpu.progress) cpu.stands_since = now;
  return now - cpu.stands_since > PatienceOf(run_.scenario).ideal;
}

// The thread stays where it is, and the world goes on to the end.
void Engine::LetWorldGoOnWithout(Task& task) {
  const double at_s = task.cpu->progress.seconds();
  if (task.process->robot->is_ideal) {
    run_.Warn(
        fmt::format("{} has been busy for {} at one instant of virtual time; its robot is "
                    "ideal, so the world waits for it, but no longer than that; from {:.3f} s on "
                    "the world goes on without it; check whether it answers its own answers",
                    task.process->name, Spoken(PatienceOf(run_.scenario).ideal.ns()), at_s));
  } else {
    run_.Warn(
        fmt::format("{} has computed for {} at one instant of the world; under --sync "
                    "callback the world waits for it, but no longer than that; from "
                    "{:.3f} s on the world goes on without it",
                    task.process->name, Spoken(MostHeld().ns()), at_s));
  }
  host_cpu_.active().Hold(task);
  task.ComeTo(task.cpu->progress);
  waker_.Wait(task, {awaited::Nothing{}});
  waker_.Refresh(*task.process->robot);
}

// Its clock has shown so much of the time to come already: it passes without the thread.
void Engine::PayDebt(Task& task, VirtualDuration passes) {
  task.debt -= passes;
  if (run_.IsCallback()) {
    ProgramClock& clock = task.process->clock;
    clock.Advance(task.cpu->progress, passes);
    task.lead = clock.lead();
    return;
  }
  task.cpu->ComeTo(task.cpu->progress + std::max(VirtualDuration(), passes));
  task.ComeTo(task.cpu->progress);
}

void Engine::StepCpu(VirtualCpu& cpu) {
  Robot& robot = *cpu.robot;
  if (!ahead_.IsNextOn(cpu)) cpu.ComeTo(std::max(cpu.progress, run_.root.Least()));
  const Moment due{.at = cpu.progress, .from_outside = true};
  if (timers_.FireDue(robot, due.at)) PollEvents(kNoWait, due);
  AwaitHandlers();
  launches_.StartDue(robot, cpu.progress);
  robot.scheduler.EndTurn(cpu.core);
  waker_.Refresh(robot);
  const RobotScheduler::Turn turn = robot.scheduler.Next(cpu.core);
  // What was due may have woken somebody who acts on another virtual CPU first; and more may be due
  // here before the turn begins.
  if (turn.start > cpu.progress || run_.root.First() != cpu.leaf) return;
  Task& task = run_.table.At(turn.thread);
  TCS_CHECK(task.reached <= cpu.progress);  // nobody runs before what has made it ready
  task.cpu = &cpu;
  ProgramClock& clock = task.process->clock;
  if (run_.IsCallback()) clock.LetWorldCatchUp(cpu.progress);
  TCS_CHECK(waker_.IsSafe(task));
  if ((run_.IsCallback() && LeftToHold(task) == VirtualDuration()) ||
      (robot.is_ideal && StandsForEver(cpu))) {
    LetWorldGoOnWithout(task);
    return;
  }
  if (!task.parked && !task.owes_ahead && !task.turns_beside) ChargeUndispatched(task);
  VirtualTime idle_until;
  const VirtualTime start = cpu.progress;
  const VirtualDuration lead = clock.lead();
  VirtualTime horizon = task.turns_beside ? task.beside_horizon : HorizonFor(task, &idle_until);
  if (!task.turns_beside &&
      GivesWay(start, horizon, run_.root.NextInput(cpu.leaf), run_.root.HasGivenWay(cpu.leaf))) {
    run_.root.GiveWay(cpu.leaf);
    return;
  }
  task.ComeTo(cpu.progress);
  run_.root.FirstActs();
  robot.scheduler.Dispatch(cpu.core, task.order);
  if (!task.turns_beside) horizon = KeepWorldNear(task, horizon);
  idle_until = std::min(idle_until, horizon);
  // Time that passes only in waiting needs none to be left.
  if (robot.is_ideal) horizon = std::max(horizon, start + VirtualNs(1));
  if (task.turns_beside) {
    TakeTurnBeside(task);
  } else if (ahead_.TakeTurn(task, horizon)) {
    // It has computed that already.
  } else if (OnlyPays(task.state, start, task.debt, horizon)) {
    PayDebt(task, horizon - start);
  } else if (spins_.IsBeforeItsLook(task)) {
    PayDebt(task, std::min(task.debt, horizon - start));
  } else {
    Dispatch(task, horizon, idle_until);
    ahead_.SendIfItComputes(task);
    if (TakePutOff({run_.latest}).looks_again) PollEvents(kNoWait, {run_.latest});
    registration_.RegisterUnannounced({run_.latest});
    TakeCallsOfNewborns({run_.latest});
    if (has_spinners_ && !task.spins) WakeSpinners();
  }
  const VirtualDuration advanced = cpu.progress - start;
  robot.scheduler.Stop(cpu.core, advanced, advanced + (clock.lead() - lead));
  waker_.Requeue(task);
  waker_.Refresh(robot);
  TCS_CHECK(run_.IsCallback() || run_.root.drift() <= run_.scenario.drift_bound);
}

// Advances the dynamics where the virtual CPUs have come to what is due there, or have left them
// behind. False if neither is so.
bool Engine::StepWorld() {
  if (!WorldGoesOn()) return false;
  const VirtualTime limit = std::min(run_.root.Least(), run_.end);
  const VirtualTime now = world_.progress();
  const VirtualDuration lag =
      limit == run_.end || run_.IsCallback() ? VirtualDuration() : run_.scenario.drift_bound;
  if (limit - now <= lag && world_.NextStop() > limit) return false;
  run_.latest = std::max(run_.latest, std::min(now, limit));
  Beat();
  const std::uint64_t begun_tsc = __rdtsc();
  state_link_.Does(Doing::kIntegrates, begun_tsc);
  const bool sent = world_.Advance(limit);
  if (world_.HasHadHelp()) ahead_.MakeRoomForHelpers();
  const std::uint64_t ended_tsc = __rdtsc();
  state_link_.Does(Doing::kSchedules, ended_tsc);
  records_.Integrated({now, world_.progress()}, {begun_tsc, ended_tsc});
  run_.root.UpdateDynamics(world_.progress(), world_.NextOutput());
  if (sent) {
    run_.latest = world_.progress();
    records_.SentSensors(run_.latest);
    dds_.ShowDeliverersTheirDeadlines();
    PollEvents(kNoWait, {.at = run_.latest, .from_outside = true});
  }
  return true;
}

// Packets arrive once nobody can act before that. False if none does.
bool Engine::StepNetwork() {
  const VirtualTime due = network_.NextDue();
  if (due > run_.root.Least() || due >= run_.end) return false;
  run_.latest = std::max(run_.latest, due);
  Beat();
  network_.Arrive(due);
  ShowNetwork(std::max(network_progress_, due));
  PollEvents(kNoWait, {.at = due, .from_outside = true});
  return true;
}

void Engine::ShowNetwork(VirtualTime progress) {
  network_progress_ = progress;
  run_.root.Update(network_leaf_, network_progress_, network_.NextDue());
}

// Returns how far the thread may run.
VirtualTime Engine::KeepWorldNear(const Task& task, VirtualTime horizon) {
  if (!WorldGoesOn() || run_.IsCallback()) return horizon;
  const VirtualTime now = task.cpu->progress, world = world_.progress();
  const auto to = WhereToLead({.now = now,
                               .world = world,
                               .horizon = horizon,
                               .apart = run_.root.Horizon(task.cpu->leaf),
                               .drift_bound = run_.scenario.drift_bound,
                               .computes = task.used_up >= Task::kComputes});
  if (to.has_value()) {
    const std::uint64_t begun_tsc = __rdtsc();
    state_link_.Does(Doing::kIntegrates, begun_tsc);
    world_.Lead(now, std::min(*to, world_.NextStop()));
    const std::uint64_t ended_tsc = __rdtsc();
    state_link_.Does(Doing::kSchedules, ended_tsc);
    records_.Integrated({world, world_.progress()}, {begun_tsc, ended_tsc});
    run_.root.UpdateDynamics(world_.progress(), world_.NextOutput());
  }
  return std::min(horizon, run_.root.DynamicsHorizon());
}

// The kernel no longer holds the thread, which was kUnseen.
void Engine::ComeBack(Task& task, Moment moment) {
  outside_.CallReturns(task, moment.at);
  waker_.Wake(task, shm::WakeReason::kGo, moment);
}

// A thread that blocked where the shim could not see it is runnable again once the kernel says so.
void Engine::PollUnseen() {
  signals_.Poll();
  if (waker_.unseen() == 0) return;
  for (Task& task : run_.table.tasks()) {
    if (task.state != TaskState::kUnseen || ThreadState(task.tid) != 'R') continue;
    run_.latest = std::max(run_.latest, task.reached);
    ComeBack(task, {run_.latest});
    task.parked = false;
    dds_.NoteWhetherStopped(*task.process, run_.latest);
  }
}

void Engine::WaitOutside() {
  Beat();
  const bool unseen = run_.gates_only || waker_.unseen() > 0 || waker_.counts().for_child() > 0 ||
                      waker_.counts().for_signals() > 0;
  PollEvents(unseen ? kUnseenPoll : kOutsidePoll, {run_.latest});
}

// Nobody runs: what comes in meanwhile happens now.
void Engine::WaitForDebugger() {
  Beat();
  PollEvents(kDebuggerPoll, {run_.latest});
}

// Before idle time is jumped over: is something from outside already there?
bool Engine::HasJumpedOver() {
  const Reactor::Found found = PollEvents(kNoWait, {run_.latest});
  PollUnseen();
  if (UnmanagedRun()) {
    PollEvents(kUnseenPoll, {run_.latest});
    return false;
  }
  return !found.wakes_others;
}

// Threads or processes that never registered are at work, or the kernel is at somebody's end: time
// waits for them.
bool Engine::UnmanagedRun() {
  std::erase_if(run_.exiting, [](pid_t tid) { return !IsExiting(tid); });
  return !run_.exiting.empty() || unmanaged_.AnyRuns() || unknown_children_.AnyRuns();
}

VirtualTime Engine::Furthest() const {
  VirtualTime furthest = world_.present() ? world_.progress() : VirtualTime();
  for (const VirtualCpu& cpu : run_.cpus) furthest = std::max(furthest, cpu.progress);
  return furthest;
}

// What need not be looked at in each step.
void Engine::LookAround() {
  const std::uint64_t begun_tsc = __rdtsc();
  if (run_.IsInGrace() || begun_tsc < next_look_tsc_) return;
  state_link_.Does(Doing::kWrites, begun_tsc);
  LookAtDetector();
  LeaveCpuIfClaimed();
  if (run_.options.on_progress) {
    if (shows_++ % (pacing_.IsWatched() ? 1 : kShowsPerFlush) == 0) {
      records_.Flush(pacing_.IsWatched());
      dds_.records().Flush();
    }
    run_.options.on_progress(reporter_.Now());
  }
  if (run_.options.on_notice) standstill_.Look(RunningTime(), Furthest());
  const std::uint64_t now_tsc = __rdtsc();
  state_link_.Does(Doing::kSchedules, now_tsc);
  next_look_tsc_ =
      now_tsc + std::max(clock_.TicksIn(kLookEveryNs), (now_tsc - begun_tsc) * kLookPause);
}

// All threads have said that they end; the kernel is about to end their processes. False once that
// is over.
bool Engine::AwaitDeaths() {
  const auto is_dead = [this](const Process& process) {
    return process.dead || (process.robot->is_ours && !run_.IsInGrace());
  };
  for (int turn = 0; turn < kDeathTurns && Living() == 0 && !launches_.AreAhead(); ++turn) {
    const bool all_dead =
        std::all_of(run_.table.processes().begin(), run_.table.processes().end(), is_dead);
    if (all_dead || grace_.IsOver() || (run_.stop.asked() && !run_.IsInGrace())) return false;
    PollEvents(kOutsidePoll, {run_.latest});
  }
  return Living() > 0 || launches_.AreAhead();
}

// Threads for which the run goes on. At its end all are waited for.
int Engine::Living() const {
  int living = run_.table.living();
  if (run_.IsInGrace()) return living;
  for (const Robot& robot : run_.robots) {
    if (robot.is_ours) living -= static_cast<int>(robot.tasks.size());
  }
  return living;
}

// Nobody acts by itself any more, and no world goes on: what is left of the run is idle time, which
// is jumped over. But those that the kernel has, or that compute without a call, may still come
// back: they get as much real time as there is virtual time left. False at the run's end.
bool Engine::AwaitOutside() {
  if (!run_.end.IsNever()) {
    const Reactor::Found found = PollEvents(kNoWait, {run_.latest});
    PollUnseen();
    if (found.wakes_others || !run_.root.Least().IsNever()) return true;
    if (waker_.unseen() == 0 && !has_spinners_ && !unknown_children_.AnyCounts() && !UnmanagedRun())
      return false;
    const VirtualTime furthest = Furthest();
    const HostTime now = RunningTime();
    if (std::exchange(idle_at_, furthest) != furthest) idle_since_ = now;
    if ((now - idle_since_).ns() >= (run_.end - furthest).ns()) return false;
  }
  if (has_spinners_) {
    WakeSpinners();
  } else {
    WaitOutside();
  }
  return true;
}

// One step of the run; false at its end.
bool Engine::Step() {
  deaths_.DropLinks();
  if (Living() == 0 && !launches_.AreAhead()) return AwaitDeaths();
  if (debugger_.Holds()) {
    WaitForDebugger();
    return true;
  }
  AwaitHandlers();
  PollUnseen();
  LookAround();
  dds_.TakeOwnMessages();
  ahead_.Look();
  if (outside_.TakeRested()) LookAgainAtHidden();
  if (outside_.IsAwaited() || shows_outside_) ShowOutside();
  // Where everything is at the start, people see who watch a run that stands there.
  if (pacing_.IsOn() && world_.present() && world_.NextStop() == VirtualTime() && StepWorld())
    return true;
  if (!KeepPace() || StepWorld() || StepNetwork() || StepOutside()) return true;
  const VirtualTime least = run_.root.Least();
  if (least >= run_.end || least.IsNever()) {
    if (least.IsNever() && !WorldGoesOn() && AwaitOutside()) return true;
    reached_end_ = true;
    return false;
  }
  BeginTurnsBeside();
  VirtualCpu& cpu = run_.cpus[static_cast<std::size_t>(run_.root.First())];
  const bool idle = cpu.robot->scheduler.Next(cpu.core).thread == RobotScheduler::kNobody;
  if (idle && !HasJumpedOver()) return true;
  // What was there may have made another one the least.
  if (run_.root.First() == cpu.leaf) StepCpu(cpu);
  return true;
}

RunReport Engine::Run() {
  for (const std::string& warning : run_.scenario.warnings) run_.Warn(warning);
  run_.report.error = Prepare();
  if (run_.report.error.empty()) {
    MakeRobots();
    run_.report.error = launches_.Begin();
  }
  clock_.Start();
  records_.StartAt(clock_);
  try {
    // While only the world goes on, nobody else looks.
    constexpr int kStepsBetweenLooksAtSignals = 64;
    for (int step = 1; run_.report.error.empty() && !run_.stop.asked(); ++step) {
      if (!Step()) break;
      if (step % kStepsBetweenLooksAtSignals == 0 && HasSignal()) OnSignal({}, 0, {});
    }
    if (!reached_end_ && run_.report.error.empty()) world_.LetLastCommandsAct(Furthest());
  } catch (const DynamicsInterrupted&) {
    OnSignal({}, 0, {});
  } catch (const DynamicsError& error) {
    run_.report.error = error.what();
  }
  state_link_.Does(Doing::kWrites, __rdtsc());
  reporter_.Conclude(reached_end_ ? run_.end : Furthest());
  // First: what clients do at their end is no part of the run.
  const std::string& folder = run_.options.output_directory;
  for (const std::string& error : {records_.Close(), datagram_log_.Close(), dds_.records().Close(),
                                   folder.empty() ? "" : network_.WriteCounts(folder)}) {
    if (run_.report.error.empty()) run_.report.error = error;
  }
  RunReport report = run_.report;
  if (run_.header != nullptr) {
    EndClients();
    Shutdown();
  }
  // What clients print at their end is theirs to be measured by, too.
  const std::string error = records_.CloseMetrics(RobotTime(report.virtual_ns));
  if (report.error.empty()) report.error = error;
  report.metrics = records_.Metrics();
  report.kept = records_.Expected();
  report.warnings = run_.report.warnings;
  return report;
}

RunReport RunScenario(const Scenario& scenario, const RunOptions& options) {
  RaiseOpenFileLimit();
  if (scenario.network) {
    if (const std::optional<NoComputer> why_not = GetReadyForComputers()) {
      RunReport refused;
      refused.error = why_not->Sentence();
      return refused;
    }
  }
  Scenario whole = scenario;
  if (auto gateway = GatewayRobot(whole, options.preload_library)) {
    whole.robots.push_back(*std::move(gateway));
  }
  return Engine(whole, options).Run();
}

}  // namespace tcs
