// The loop: advance the dynamics, choose the least advanced virtual CPU, let it act.
#include "coordinator/core/engine.h"

#include <fmt/format.h>
#include <time.h>
#include <x86gprintrin.h>

#include <algorithm>
#include <utility>

#include "coordinator/host/fifo_executor.h"
#include "coordinator/host/gate_executor.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"
#include "coordinator/os/own_computer.h"
#include "shm/check.h"

namespace tcs {

namespace {

constexpr std::int64_t kUnseenPollNs = 1'000'000;
constexpr std::int64_t kDebuggerPollNs = 10'000'000;
constexpr std::int64_t kOutsidePollNs = 200'000'000;
constexpr std::int64_t kMostHeldNs = 10'000'000'000;  // of the world, at one instant
constexpr int kDeathTurns = 25;                       // of kOutsidePollNs
constexpr std::int64_t kLookEveryNs = 200'000'000;
constexpr std::uint64_t kLookPause = 50;  // times what the last look took, at the least
constexpr int kShowsPerFlush = 5;
constexpr std::int64_t kLeastLookNs = 10'000;  // between looks at timers that rest

std::unique_ptr<Executor> MakeExecutor(bool gates_only) {
  if (gates_only) return std::make_unique<GateExecutor>();
  return std::make_unique<FifoExecutor>();
}

}  // namespace

Engine::Engine(const Scenario& scenario, const RunOptions& options)
    : run_(scenario, options, !WhyNoRealTime().empty(), WhyNoDuplicates() != 0),
      activations_(run_.IsCallback()),
      executor_(MakeExecutor(run_.gates_only)),
      host_cpu_(*executor_) {
  TellOfWaits();
  TellOfEnds();
}

Engine::~Engine() = default;

// `idle_until`: the thread may sleep that far without asking, for nothing else happens here before.
std::int64_t Engine::HorizonFor(const Task& task, std::int64_t* idle_until) {
  const VirtualCpu& cpu = *task.cpu;
  const Robot& robot = *cpu.robot;
  const std::int64_t furthest = cpu.progress_ns + shm::kMaxDispatchNs - 1;
  *idle_until = 0;
  if (run_.IsCallback()) {
    return std::min({furthest, robot.scheduler.HorizonWhileWorldStands(cpu.core, task.order),
                     cpu.progress_ns + LeftToHoldNs(task)});
  }
  std::int64_t limit = std::min(run_.root.Horizon(cpu.leaf), furthest);
  if (task.process->timers.HasCpuTimers()) {
    const std::int64_t left = task.process->timers.CpuTimeToExpiry(TimerCalls::CpuUsedBy(task));
    if (left != shm::kNeverNs) limit = std::min(limit, cpu.progress_ns + left);
  }
  limit = std::min(limit, std::max(robot.next_launch_ns, cpu.progress_ns));
  limit =
      std::min(limit, std::max(task.process->timers.NextLook(), cpu.progress_ns + kLeastLookNs));
  const RobotScheduler::Horizon horizon =
      robot.scheduler.HorizonOf(cpu.core, task.order, limit,
                                {.input_ns = run_.root.NextInput(cpu.leaf),
                                 .outside_input_ns = run_.root.NextInputFromOutside(cpu.leaf),
                                 .output_ns = run_.root.NextOutput(),
                                 .acts_at_once = run_.IsFixed() || robot.is_ideal,
                                 .has_given_way = run_.root.HasGivenWay(cpu.leaf)});
  *idle_until = horizon.idle_ns;
  return horizon.run_ns;
}

// A program that computes for as long as the run is to be, all at one instant of the world's, would
// have the world stand for ever. Short runs, too, may have long plans computed.
std::int64_t Engine::MostHeldNs() const {
  return run_.IsInGrace() ? kMostHeldNs : std::max(kMostHeldNs, run_.scenario.duration.ns());
}

std::int64_t Engine::LeftToHoldNs(const Task& task) const {
  const VirtualDuration held = task.process->clock.HeldAt(RobotTime(task.cpu->progress_ns));
  return std::clamp<std::int64_t>(MostHeldNs() - held.ns(), 0, shm::kMaxDispatchNs);
}

// The virtual CPU of an ideal robot has been at this instant for long, of real time, though its
// threads stop and go on: they may be answering each other for ever.
bool Engine::StandsForEver(VirtualCpu& cpu) const {
  const std::int64_t now_ns = RunningNs();
  if (std::exchange(cpu.stands_at_ns, cpu.progress_ns) != cpu.progress_ns) {
    cpu.stands_since_ns = now_ns;
  }
  return now_ns - cpu.stands_since_ns > kMostHeldNs;
}

// The thread stays where it is, and the world goes on to the end.
void Engine::LetWorldGoOnWithout(Task& task) {
  const double at_s = static_cast<double>(task.cpu->progress_ns) * 1e-9;
  if (task.process->robot->is_ideal) {
    run_.Warn(
        fmt::format("{} has been busy for {:.0f} s at one instant of virtual time; its robot is "
                    "ideal, so the world waits for it, but no longer than that; from {:.3f} s on "
                    "the world goes on without it; check whether it answers its own answers",
                    task.process->name, static_cast<double>(kMostHeldNs) * 1e-9, at_s));
  } else {
    run_.Warn(
        fmt::format("{} has computed for {:.0f} s at one instant of the world; under --sync "
                    "callback the world waits for it, but no longer than the run is to last; from "
                    "{:.3f} s on the world goes on without it",
                    task.process->name, static_cast<double>(MostHeldNs()) * 1e-9, at_s));
  }
  host_cpu_.active().Hold(task);
  task.reached_ns = task.cpu->progress_ns;
  waker_.Wait(task, {awaited::Nothing{}});
  waker_.Refresh(*task.process->robot);
}

// Its clock has shown so much of the time to come already: it passes without the thread.
void Engine::PayDebt(Task& task, std::int64_t ns) {
  task.debt_ns -= ns;
  if (run_.IsCallback()) {
    ProgramClock& clock = task.process->clock;
    clock.Advance(RobotTime(task.cpu->progress_ns), VirtualDuration::Nanoseconds(ns));
    task.lead = clock.lead();
    return;
  }
  task.cpu->ComeTo(task.cpu->progress_ns + std::max<std::int64_t>(0, ns));
  task.reached_ns = task.cpu->progress_ns;
}

void Engine::StepCpu(VirtualCpu& cpu) {
  Robot& robot = *cpu.robot;
  if (!ahead_.IsNextOn(cpu)) cpu.ComeTo(std::max(cpu.progress_ns, run_.root.Least()));
  const Moment due{.ns = cpu.progress_ns, .from_outside = true};
  if (timers_.FireDue(robot, due.ns)) PollEvents(0, due);
  launches_.StartDue(robot, cpu.progress_ns);
  robot.scheduler.EndTurn(cpu.core);
  waker_.Refresh(robot);
  const RobotScheduler::Turn turn = robot.scheduler.Next(cpu.core);
  // What was due may have woken somebody who acts on another virtual CPU first; and more may be due
  // here before the turn begins.
  if (turn.start_ns > cpu.progress_ns || run_.root.First() != cpu.leaf) return;
  Task& task = run_.table.At(turn.thread);
  TCS_CHECK(task.reached_ns <= cpu.progress_ns);  // nobody runs before what has made it ready
  task.cpu = &cpu;
  ProgramClock& clock = task.process->clock;
  if (run_.IsCallback()) clock.LetWorldCatchUp(RobotTime(cpu.progress_ns));
  TCS_CHECK(waker_.IsSafe(task));
  if ((run_.IsCallback() && LeftToHoldNs(task) == 0) || (robot.is_ideal && StandsForEver(cpu))) {
    LetWorldGoOnWithout(task);
    return;
  }
  if (!task.parked && !task.owes_ahead) ChargeUndispatched(task);
  std::int64_t idle_until = 0;
  const std::int64_t start = cpu.progress_ns;
  const VirtualDuration lead = clock.lead();
  std::int64_t horizon = HorizonFor(task, &idle_until);
  if (horizon <= start && run_.root.NextInput(cpu.leaf) == start &&
      !run_.root.HasGivenWay(cpu.leaf)) {
    // At this very instant others may still wake somebody who goes before it.
    run_.root.GiveWay(cpu.leaf);
    return;
  }
  task.reached_ns = cpu.progress_ns;
  run_.root.FirstActs();
  robot.scheduler.Dispatch(cpu.core, task.order);
  horizon = KeepWorldNear(task, horizon);
  idle_until = std::min(idle_until, horizon);
  // Time that passes only in waiting needs none to be left.
  if (robot.is_ideal) horizon = std::max(horizon, start + 1);
  if (ahead_.TakeTurn(task, horizon)) {
    // It has computed that already.
  } else if (task.state != TaskState::kStarting && start + task.debt_ns >= horizon) {
    PayDebt(task, horizon - start);
  } else {
    Dispatch(task, horizon, idle_until);
    ahead_.SendIfItComputes(task);
    if (TakePutOff({run_.latest_ns}).looks_again) PollEvents(0, {run_.latest_ns});
    registration_.RegisterUnannounced({run_.latest_ns});
    if (has_spinners_ && !task.spins) WakeSpinners();
  }
  const std::int64_t advanced = cpu.progress_ns - start;
  robot.scheduler.Stop(cpu.core, advanced, advanced + (clock.lead() - lead).ns());
  waker_.Requeue(task);
  waker_.Refresh(robot);
  TCS_CHECK(run_.IsCallback() || run_.root.drift_ns() <= run_.scenario.drift_bound.ns());
}

// Advances the dynamics where the virtual CPUs have come to what is due there, or have left them
// behind. False if neither is so.
bool Engine::StepWorld() {
  if (!WorldGoesOn()) return false;
  const std::int64_t limit = std::min(run_.root.Least(), run_.end_ns);
  const std::int64_t now = world_.progress_ns();
  const std::int64_t lag =
      limit == run_.end_ns || run_.IsCallback() ? 0 : run_.scenario.drift_bound.ns();
  if (limit - now <= lag && world_.NextStopNs() > limit) return false;
  run_.latest_ns = std::max(run_.latest_ns, std::min(now, limit));
  Beat();
  const std::uint64_t begun_tsc = __rdtsc();
  state_link_.Does(Doing::kIntegrates, begun_tsc);
  const bool sent = world_.Advance(limit);
  const std::uint64_t ended_tsc = __rdtsc();
  state_link_.Does(Doing::kSchedules, ended_tsc);
  records_.Integrated({now, world_.progress_ns()}, {begun_tsc, ended_tsc});
  run_.root.UpdateDynamics(world_.progress_ns(), world_.NextOutputNs());
  if (sent) {
    run_.latest_ns = world_.progress_ns();
    records_.SentSensors(run_.latest_ns);
    dds_.ShowDeliverersTheirDeadlines();
    PollEvents(0, {.ns = run_.latest_ns, .from_outside = true});
  }
  return true;
}

// Packets arrive once nobody can act before that. False if none does.
bool Engine::StepNetwork() {
  const std::int64_t due_ns = network_.NextDue().ns();
  if (due_ns > run_.root.Least() || due_ns >= run_.end_ns) return false;
  run_.latest_ns = std::max(run_.latest_ns, due_ns);
  Beat();
  network_.Arrive(VirtualTime::FromNanoseconds(due_ns));
  ShowNetwork(std::max(network_ns_, due_ns));
  PollEvents(0, {.ns = due_ns, .from_outside = true});
  return true;
}

void Engine::ShowNetwork(std::int64_t progress_ns) {
  network_ns_ = progress_ns;
  run_.root.Update(network_leaf_, network_ns_, network_.NextDue().ns());
}

// To move the dynamics costs next to nothing, but every horizon costs a context switch. So they may
// lag behind while threads act for short, and where a thread computes on and on they lead: within
// the drift bound on either side its slices are twice as long. Returns how far the thread may run.
std::int64_t Engine::KeepWorldNear(const Task& task, std::int64_t horizon_ns) {
  if (!WorldGoesOn() || run_.IsCallback()) return horizon_ns;
  const std::int64_t bound = std::min(run_.scenario.drift_bound.ns(), shm::kMaxDispatchNs);
  const std::int64_t now = task.cpu->progress_ns, world = world_.progress_ns();
  const bool computes = task.used_up >= Task::kComputes;
  const std::int64_t room = computes ? horizon_ns : std::min(horizon_ns, now + bound / 2);
  if (world + bound < room) {
    // As far as they may: the fewer slices, the better.
    const std::int64_t to =
        computes ? std::min(now + bound, run_.root.Horizon(task.cpu->leaf)) : now;
    const std::uint64_t begun_tsc = __rdtsc();
    state_link_.Does(Doing::kIntegrates, begun_tsc);
    world_.Lead(now, std::min(to, world_.NextStopNs()));
    const std::uint64_t ended_tsc = __rdtsc();
    state_link_.Does(Doing::kSchedules, ended_tsc);
    records_.Integrated({world, world_.progress_ns()}, {begun_tsc, ended_tsc});
    run_.root.UpdateDynamics(world_.progress_ns(), world_.NextOutputNs());
  }
  return std::min(horizon_ns, run_.root.DynamicsHorizon());
}

// A thread that blocked where the shim could not see it is runnable again once the kernel says so.
void Engine::PollUnseen() {
  signals_.Poll();
  if (waker_.unseen() == 0) return;
  for (Task& task : run_.table.tasks()) {
    if (task.state != TaskState::kUnseen || ThreadState(task.tid) != 'R') continue;
    run_.latest_ns = std::max(run_.latest_ns, task.reached_ns);
    waker_.Wake(task, shm::WakeReason::kGo, {run_.latest_ns});
    task.parked = false;
    dds_.NoteWhetherStopped(*task.process, run_.latest_ns);
  }
}

void Engine::WaitOutside() {
  Beat();
  const bool unseen = run_.gates_only || waker_.unseen() > 0 || waker_.counts().for_child() > 0 ||
                      waker_.counts().for_signals() > 0;
  PollEvents(unseen ? kUnseenPollNs : kOutsidePollNs, {run_.latest_ns});
}

// Nobody runs: what comes in meanwhile happens now.
void Engine::WaitForDebugger() {
  Beat();
  PollEvents(kDebuggerPollNs, {run_.latest_ns});
}

// Before idle time is jumped over: is something from outside already there?
bool Engine::HasJumpedOver() {
  const Reactor::Found found = PollEvents(0, {run_.latest_ns});
  PollUnseen();
  if (UnmanagedRun()) {
    PollEvents(kUnseenPollNs, {run_.latest_ns});
    return false;
  }
  return !found.wakes_others;
}

// Threads or processes that never registered are at work: time waits for them.
bool Engine::UnmanagedRun() const { return unmanaged_.AnyRuns() || unknown_children_.AnyRuns(); }

std::int64_t Engine::FurthestNs() const {
  std::int64_t furthest_ns = world_.present() ? world_.progress_ns() : 0;
  for (const VirtualCpu& cpu : run_.cpus) furthest_ns = std::max(furthest_ns, cpu.progress_ns);
  return furthest_ns;
}

// What need not be looked at in each step.
void Engine::LookAround() {
  const std::uint64_t begun_tsc = __rdtsc();
  if (run_.IsInGrace() || begun_tsc < next_look_tsc_) return;
  state_link_.Does(Doing::kWrites, begun_tsc);
  LookAtDetector();
  if (run_.options.on_progress) {
    if (shows_++ % (pacing_.IsWatched() ? 1 : kShowsPerFlush) == 0) {
      records_.Flush();
      dds_.records().Flush();
    }
    run_.options.on_progress(reporter_.Now());
  }
  if (run_.options.on_notice) standstill_.Look(RunningNs(), FurthestNs());
  const std::uint64_t now_tsc = __rdtsc();
  state_link_.Does(Doing::kSchedules, now_tsc);
  next_look_tsc_ =
      now_tsc + std::max(clock_.TicksIn(kLookEveryNs), (now_tsc - begun_tsc) * kLookPause);
}

// All threads have said that they end; the kernel is about to end their processes. False once that
// is over.
bool Engine::AwaitDeaths() {
  for (int turn = 0; turn < kDeathTurns && run_.table.living() == 0 && !launches_.AreAhead();
       ++turn) {
    const bool all_dead = std::all_of(run_.table.processes().begin(), run_.table.processes().end(),
                                      [](const Process& process) { return process.dead; });
    if (all_dead || grace_.IsOver() || (run_.stop.asked() && !run_.IsInGrace())) return false;
    PollEvents(kOutsidePollNs, {run_.latest_ns});
  }
  return run_.table.living() > 0 || launches_.AreAhead();
}

// Nobody acts by itself any more, and no world goes on: what is left of the run is idle time, which
// is jumped over. But those that the kernel has, or that compute without a call, may still come
// back: they get as much real time as there is virtual time left. False at the run's end.
bool Engine::AwaitOutside() {
  if (run_.end_ns != shm::kNeverNs) {
    const Reactor::Found found = PollEvents(0, {run_.latest_ns});
    PollUnseen();
    if (found.wakes_others || run_.root.Least() != shm::kNeverNs) return true;
    if (waker_.unseen() == 0 && !has_spinners_ && !unknown_children_.AnyCounts() && !UnmanagedRun())
      return false;
    const std::int64_t furthest_ns = FurthestNs(), now_ns = RunningNs();
    if (std::exchange(idle_at_ns_, furthest_ns) != furthest_ns) idle_since_real_ns_ = now_ns;
    if (now_ns - idle_since_real_ns_ >= run_.end_ns - furthest_ns) return false;
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
  if (run_.table.living() == 0 && !launches_.AreAhead()) return AwaitDeaths();
  if (debugger_.Holds()) {
    WaitForDebugger();
    return true;
  }
  PollUnseen();
  LookAround();
  dds_.TakeOwnMessages();
  ahead_.Look();
  if (!KeepPace() || StepWorld() || StepNetwork()) return true;
  const std::int64_t least = run_.root.Least();
  if (least >= run_.end_ns || least == shm::kNeverNs) {
    if (least == shm::kNeverNs && !WorldGoesOn() && AwaitOutside()) return true;
    reached_end_ = true;
    return false;
  }
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
    while (run_.report.error.empty() && !run_.stop.asked()) {
      if (!Step()) break;
    }
  } catch (const DynamicsError& error) {
    run_.report.error = error.what();
  }
  state_link_.Does(Doing::kWrites, __rdtsc());
  reporter_.Conclude(reached_end_ ? run_.end_ns : FurthestNs());
  // First: what clients do at their end is no part of the run.
  const std::string& folder = run_.options.output_directory;
  for (const std::string& error : {records_.Close(), datagrams_.Close(), dds_.records().Close(),
                                   folder.empty() ? "" : network_.WriteCounts(folder)}) {
    if (run_.report.error.empty()) run_.report.error = error;
  }
  RunReport report = run_.report;
  if (run_.header != nullptr) {
    EndClients();
    Shutdown();
  }
  report.warnings = run_.report.warnings;
  return report;
}

RunReport RunScenario(const Scenario& scenario, const RunOptions& options) {
  if (scenario.network) {
    if (const std::optional<NoComputer> why_not = GetReadyForComputers()) {
      RunReport refused;
      refused.error = why_not->Sentence();
      return refused;
    }
  }
  return Engine(scenario, options).Run();
}

}  // namespace tcs
