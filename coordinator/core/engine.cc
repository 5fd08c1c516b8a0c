// The loop: advance the dynamics, choose the least advanced virtual CPU, let it act.
#include "coordinator/core/engine.h"

#include <errno.h>
#include <fmt/format.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>
#include <x86intrin.h>

#include <algorithm>
#include <utility>

#include "coordinator/host/fifo_executor.h"
#include "coordinator/host/gate_executor.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"
#include "shm/check.h"

namespace tcs {

namespace {

constexpr std::int64_t kUnseenPollNs = 1'000'000;
constexpr std::int64_t kOutsidePollNs = 200'000'000;
constexpr std::int64_t kMostHeldNs = 10'000'000'000;  // of the world, at one instant
constexpr int kDeathTurns = 25;                       // of kOutsidePollNs
constexpr std::int64_t kLookEveryNs = 200'000'000;
constexpr std::uint64_t kLookPause = 50;  // times what the last look took, at the least
constexpr int kShowsPerFlush = 5;
constexpr std::int64_t kLeastLookNs = 10'000;  // between looks at timers that rest
constexpr int kComputes = 3;  // Task::used_up of a thread that is expected to go on

std::unique_ptr<Executor> MakeExecutor(bool gates_only) {
  if (gates_only) return std::make_unique<GateExecutor>();
  return std::make_unique<FifoExecutor>();
}

}  // namespace

Engine::Engine(const Scenario& scenario, const RunOptions& options)
    : scenario_(scenario),
      options_(options),
      root_(scenario.drift_bound.ns(), scenario.duration.ns()),
      activations_(options.sync == shm::Sync::kCallback),
      table_([](pid_t pid) { return ThreadState(pid) != 'Z'; }),
      gates_only_(!WhyNoRealTime().empty()),
      executor_(MakeExecutor(gates_only_)),
      host_cpu_(*executor_),
      end_ns_(scenario.duration.ns()) {}

Engine::~Engine() = default;

void Engine::Warn(const std::string& text) {
  if (std::find(report_.warnings.begin(), report_.warnings.end(), text) == report_.warnings.end()) {
    report_.warnings.push_back(text);
    if (options_.on_warning) options_.on_warning(text);
  }
}

bool Engine::IsRunnable(const Task& task) {
  return task.state == TaskState::kReady || task.state == TaskState::kHolding ||
         task.state == TaskState::kStarting;
}

void Engine::SetState(Task& task, TaskState state, bool goes_first) {
  TCS_CHECK(MayFollow(task.state, state));
  TCS_CHECK(task.wait.has_value() == (state == TaskState::kWaiting));
  const bool ends = state == TaskState::kWaiting || state == TaskState::kDead;
  if (ends && task.state != TaskState::kWaiting) activations_.Idles(task);
  if (const int more = (state == TaskState::kUnseen) - (task.state == TaskState::kUnseen);
      more != 0) {
    unseen_ += more;
    header_->kernel_waiters.store(static_cast<std::uint32_t>(unseen_));
  }
  task.state = state;
  Requeue(task, goes_first);
  // A deliverer that waits for something else must not be waited for: it may need what those hold.
  if (task.is_deliverer && !IsRunnable(task) && task.Awaits<awaited::Messages>() == nullptr) {
    ReleaseThoseAwaitingDeliverer(*task.process,
                                  {turn_.IsOf(task) ? WrittenAt() : task.reached_ns});
  }
}

void Engine::Requeue(Task& task, bool goes_first) {
  if (IsRunnable(task)) {
    SchedulerOf(task).Enqueue(task.order, task.reached_ns, goes_first);
  } else {
    SchedulerOf(task).Dequeue(task.order);
  }
}

// Whether a wait is over by time: the world's, or, where others of its process compute while the
// world stands still, that of the process's own clock.
bool Engine::HasRunOut(const Task& task, std::int64_t now_ns) const {
  if (!task.wait.has_value()) return false;
  const std::int64_t deadline_ns = task.wait->deadline_ns;
  if (deadline_ns <= now_ns) return true;
  return IsCallback() && OwnDeadlineOf(task) <= task.process->clock.shown();
}

// When the thread's wait is over, as its process's clock tells it.
ProgramTime Engine::OwnDeadlineOf(const Task& task) {
  return ProgramClock::At(RobotTime(task.wait->deadline_ns), task.lead);
}

RobotScheduler::Wait Engine::WaitOf(const Task& task) const {
  const Process& process = *task.process;
  RobotScheduler::Wait wait{.process = process.index,
                            .next_expiry_ns = process.timers.NextExpiry()};
  wait.waits = task.wait.has_value() && task.Awaits<awaited::OthersRun>() == nullptr;
  if (!wait.waits) return wait;
  wait.for_input = IsForInput(*task.wait);
  wait.for_thread = task.Awaits<awaited::Futex>() != nullptr;
  wait.from_ns = task.reached_ns;
  wait.until_ns = task.wait->deadline_ns;
  if (IsCallback() && wait.until_ns != shm::kNeverNs) {
    wait.is_over = HasRunOut(task, 0);
    wait.own_until_ns = process.clock.RobotTimeOf(OwnDeadlineOf(task)).ns();
  }
  return wait;
}

void Engine::Refresh(Robot& robot) {
  robot.scheduler.Assign(robot.next_launch_ns);
  for (const VirtualCpu* cpu : robot.cpus) {
    root_.Update(cpu->leaf, cpu->progress_ns, robot.scheduler.NextActionOf(cpu->core));
  }
}

void Engine::MakeReady(Task& task, shm::WakeReason reason, Moment moment) {
  if (task.state == TaskState::kDead) return;
  const bool waited = task.wait.has_value(), reads = waited && LooksAtOthers(*task.wait);
  const bool for_messages = task.Awaits<awaited::Messages>() != nullptr;
  const bool outside = moment.from_outside || (turn_.lasts() && !turn_.IsOn(*task.process->robot));
  const bool goes_first = outside && waited && SchedulerOf(task).PreemptsOnWakeup(task.order);
  if (outside && reads && !for_messages) NoteLateness(task, moment.ns, goes_first);
  if (waited) {
    ++task.activations;
    activations_.Released(task, reason, moment.ns);
    task.debt_ns = std::max<std::int64_t>(0, task.debt_ns);  // credit ends with the activation
  }
  task.reached_ns = std::max({task.reached_ns, moment.ns, EarliestWake()});
  if (waited) {
    // Where somebody more urgent ran on, the kernel's timer would still have been in time.
    const bool timed = reason == shm::WakeReason::kDeadline;
    const std::int64_t released_ns =
        timed ? std::min(task.wait->deadline_ns, task.reached_ns) : task.reached_ns;
    SchedulerOf(task).WakeUp(task.order, released_ns, outside);
  }
  // Others may have come further: what is due later than its own time it gets then.
  if (for_messages) {
    task.messages_until_ns =
        reason == shm::WakeReason::kDeadline ? task.wait->deadline_ns : task.reached_ns;
  }
  if (waited && task.wait->is_in_trapped_call) FinishTrappedWait(task, reason);
  LeaveWait(task);
  // Whoever waited for others looks at what they did: that must be all of it.
  SetState(task, reads && !IsCallback() ? TaskState::kHolding : TaskState::kReady, goes_first);
  task.hold = shm::NotificationKind::kRead;
  task.reason = reason;
  Refresh(*task.process->robot);
}

// What arrives later than the drift bound allows for (the kernel may take its time) is seen when
// that is over, not in the past of those who have gone on.
std::int64_t Engine::EarliestWake() const {
  if (IsCallback()) return 0;
  std::int64_t earliest = root_.EarliestWake();
  if (turn_.lasts()) earliest = std::max(earliest, WrittenAt() - scenario_.drift_bound.ns());
  return earliest;
}

// What was sent at `sent_ns` wakes a thread. The core that it runs on at once may have come
// further.
void Engine::NoteLateness(const Task& woken, std::int64_t sent_ns, bool goes_first) {
  if (IsCallback()) return;
  sent_ns = std::max(sent_ns, woken.reached_ns);  // since then it has waited
  const std::int64_t late_ns =
      SchedulerOf(woken).LatenessOf(woken.order, sent_ns, EarliestWake(), goes_first);
  report_.lateness_ns = std::max(report_.lateness_ns, late_ns);
}

bool Engine::IsSafe(const Task& task) const {
  if (task.state != TaskState::kHolding) return true;
  const VirtualCpu& cpu = *task.cpu;
  return cpu.progress_ns <= (task.hold == shm::NotificationKind::kRead ? root_.ReadSafe(cpu.leaf)
                                                                       : root_.WriteSafe(cpu.leaf));
}

// `idle_until`: the thread may sleep that far without asking, for nothing else happens here before.
std::int64_t Engine::HorizonFor(const Task& task, std::int64_t* idle_until) {
  const VirtualCpu& cpu = *task.cpu;
  const Robot& robot = *cpu.robot;
  const std::int64_t furthest = cpu.progress_ns + shm::kMaxDispatchNs - 1;
  *idle_until = 0;
  if (IsCallback()) {
    return std::min({furthest, robot.scheduler.HorizonWhileWorldStands(cpu.core, task.order),
                     cpu.progress_ns + LeftToHoldNs(task)});
  }
  std::int64_t limit = std::min(root_.Horizon(cpu.leaf), furthest);
  if (task.process->timers.HasCpuTimers()) {
    const std::int64_t left = task.process->timers.CpuTimeToExpiry(CpuUsedBy(task));
    if (left != shm::kNeverNs) limit = std::min(limit, cpu.progress_ns + left);
  }
  limit = std::min(limit, std::max(robot.next_launch_ns, cpu.progress_ns));
  limit =
      std::min(limit, std::max(task.process->timers.NextLook(), cpu.progress_ns + kLeastLookNs));
  const RobotScheduler::Horizon horizon =
      robot.scheduler.HorizonOf(cpu.core, task.order, limit,
                                {.input_ns = root_.NextInput(cpu.leaf),
                                 .outside_input_ns = root_.NextInputFromOutside(cpu.leaf),
                                 .output_ns = root_.NextOutput(),
                                 .acts_at_once = IsFixed(),
                                 .has_given_way = root_.HasGivenWay(cpu.leaf)});
  *idle_until = horizon.idle_ns;
  return horizon.run_ns;
}

// A program that computes for as long as the run is to be, all at one instant of the world's, would
// have the world stand for ever. Short runs, too, may have long plans computed.
std::int64_t Engine::MostHeldNs() const {
  return IsInGrace() ? kMostHeldNs : std::max(kMostHeldNs, scenario_.duration.ns());
}

std::int64_t Engine::LeftToHoldNs(const Task& task) const {
  const VirtualDuration held = task.process->clock.HeldAt(RobotTime(task.cpu->progress_ns));
  return std::clamp<std::int64_t>(MostHeldNs() - held.ns(), 0, shm::kMaxDispatchNs);
}

// The thread stays where it is, and the world goes on to the end.
void Engine::LetWorldGoOnWithout(Task& task) {
  Warn(
      fmt::format("{} has computed for {:.0f} s at one instant of the world's: under --sync "
                  "callback the world waits for it, but not for longer than the run is to be; from "
                  "{:.3f} s on it goes on without that program",
                  task.process->name, static_cast<double>(MostHeldNs()) * 1e-9,
                  static_cast<double>(task.cpu->progress_ns) * 1e-9));
  host_cpu_.active().Hold(task);
  task.reached_ns = task.cpu->progress_ns;
  EnterWait(task, {awaited::Nothing{}});
  Refresh(*task.process->robot);
}

// Its clock has shown so much of the time to come already: it passes without the thread.
void Engine::PayDebt(Task& task, std::int64_t ns) {
  task.debt_ns -= ns;
  if (IsCallback()) {
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
  cpu.ComeTo(std::max(cpu.progress_ns, root_.Least()));
  FireDue(robot, cpu.progress_ns);
  StartDue(robot, cpu.progress_ns);
  robot.scheduler.EndTurn(cpu.core);
  Refresh(robot);
  const RobotScheduler::Turn turn = robot.scheduler.Next(cpu.core);
  // What was due may have woken somebody who acts on another virtual CPU first; and more may be due
  // here before the turn begins.
  if (turn.start_ns > cpu.progress_ns || root_.First() != cpu.leaf) return;
  Task& task = TaskAt(turn.thread);
  TCS_CHECK(task.reached_ns <= cpu.progress_ns);  // nobody runs before what has made it ready
  task.cpu = &cpu;
  ProgramClock& clock = task.process->clock;
  if (IsCallback()) clock.LetWorldCatchUp(RobotTime(cpu.progress_ns));
  TCS_CHECK(IsSafe(task));
  if (IsCallback() && LeftToHoldNs(task) == 0) {
    LetWorldGoOnWithout(task);
    return;
  }
  if (!task.parked) ChargeUndispatched(task);
  std::int64_t idle_until = 0;
  const std::int64_t start = cpu.progress_ns;
  const VirtualDuration lead = clock.lead();
  std::int64_t horizon = HorizonFor(task, &idle_until);
  if (horizon <= start && root_.NextInput(cpu.leaf) == start && !root_.HasGivenWay(cpu.leaf)) {
    // At this very instant others may still wake somebody who goes before it.
    root_.GiveWay(cpu.leaf);
    return;
  }
  task.reached_ns = cpu.progress_ns;
  root_.FirstActs();
  robot.scheduler.Dispatch(cpu.core, task.order);
  horizon = KeepWorldNear(task, horizon);
  idle_until = std::min(idle_until, horizon);
  if (task.state != TaskState::kStarting && start + task.debt_ns >= horizon) {
    PayDebt(task, horizon - start);
  } else {
    Dispatch(task, horizon, idle_until);
    if (TakePutOff({latest_ns_}).looks_again) PollEvents(0, {latest_ns_});
    RegisterUnannounced({latest_ns_});
    if (has_spinners_ && !task.spins) WakeSpinners();
  }
  const std::int64_t advanced = cpu.progress_ns - start;
  robot.scheduler.Stop(cpu.core, advanced, advanced + (clock.lead() - lead).ns());
  Requeue(task);
  Refresh(robot);
  TCS_CHECK(IsCallback() || root_.drift_ns() <= scenario_.drift_bound.ns());
}

// Advances the dynamics where the virtual CPUs have come to what is due there, or have left them
// behind. False if neither is so.
bool Engine::StepWorld() {
  if (!WorldGoesOn()) return false;
  const std::int64_t limit = std::min(root_.Least(), end_ns_);
  const std::int64_t now = world_.progress_ns();
  const std::int64_t lag = limit == end_ns_ || IsCallback() ? 0 : scenario_.drift_bound.ns();
  if (limit - now <= lag && world_.NextStopNs() > limit) return false;
  latest_ns_ = std::max(latest_ns_, std::min(now, limit));
  Beat();
  const std::uint64_t begun_tsc = __rdtsc();
  const bool sent = world_.Advance(limit);
  const std::uint64_t ended_tsc = __rdtsc();
  const DispatchLog::Span span{now, world_.progress_ns()};
  schedule_.Slice(world_row_, span, span, {begun_tsc, ended_tsc});
  root_.UpdateDynamics(world_.progress_ns(), world_.NextOutputNs());
  if (sent) {
    latest_ns_ = world_.progress_ns();
    schedule_.Instant(world_row_, "sensors", latest_ns_);
    ShowDeliverersTheirDeadlines();
    PollEvents(0, {.ns = latest_ns_, .from_outside = true});
  }
  return true;
}

// Every stop of the dynamics costs a step of the integrator, and every horizon a context switch. So
// they may lag behind while threads act for short, and where a thread computes on and on they lead:
// within the drift bound on either side its slices are twice as long. Returns how far the thread
// may run.
std::int64_t Engine::KeepWorldNear(const Task& task, std::int64_t horizon_ns) {
  if (!WorldGoesOn() || IsCallback()) return horizon_ns;
  const std::int64_t bound = std::min(scenario_.drift_bound.ns(), shm::kMaxDispatchNs);
  const std::int64_t now = task.cpu->progress_ns, world = world_.progress_ns();
  const bool computes = task.used_up >= kComputes;
  const std::int64_t room = computes ? horizon_ns : std::min(horizon_ns, now + bound / 2);
  if (world + bound < room) {
    // As far as they may: the fewer stops, the better.
    const std::int64_t to = computes ? now + bound : now;
    const std::uint64_t begun_tsc = __rdtsc();
    world_.Lead(now, std::min(to, world_.NextStopNs()));
    const std::uint64_t ended_tsc = __rdtsc();
    const DispatchLog::Span span{world, world_.progress_ns()};
    schedule_.Slice(world_row_, span, span, {begun_tsc, ended_tsc});
    root_.UpdateDynamics(world_.progress_ns(), world_.NextOutputNs());
  }
  return std::min(horizon_ns, root_.DynamicsHorizon());
}

// A thread that blocked where the shim could not see it is runnable again once the kernel says so.
void Engine::PollUnseen() {
  PollSignals();
  if (unseen_ == 0) return;
  for (Task& task : table_.tasks()) {
    if (task.state != TaskState::kUnseen || ThreadState(task.tid) != 'R') continue;
    latest_ns_ = std::max(latest_ns_, task.reached_ns);
    MakeReady(task, shm::WakeReason::kGo, {latest_ns_});
    task.parked = false;
    NoteWhetherStopped(*task.process, latest_ns_);
  }
}

void Engine::WaitOutside() {
  Beat();
  const bool unseen =
      gates_only_ || unseen_ > 0 || wait_counts_.for_child() > 0 || wait_counts_.for_signals() > 0;
  PollEvents(unseen ? kUnseenPollNs : kOutsidePollNs, {latest_ns_});
}

// Before idle time is jumped over: is something from outside already there?
bool Engine::HasJumpedOver() {
  const Reactor::Found found = PollEvents(0, {latest_ns_});
  PollUnseen();
  if (StrangersRun()) {
    PollEvents(kUnseenPollNs, {latest_ns_});
    return false;
  }
  return !found.wakes_others;
}

// Threads that never registered are at work: time waits for them.
bool Engine::StrangersRun() {
  for (const Process& process : table_.processes()) {
    if (!process.has_strangers || process.dead) continue;
    for (const pid_t tid : ThreadsOf(process.pid)) {
      if (KnownTask(tid) != nullptr || IsAstray(tid)) continue;
      if (const char state = ThreadState(tid); state == 'R' || state == 'D') return true;
    }
  }
  return UnknownChildrenRun();
}

std::int64_t Engine::FurthestNs() const {
  std::int64_t furthest_ns = world_.present() ? world_.progress_ns() : 0;
  for (const VirtualCpu& cpu : cpus_) furthest_ns = std::max(furthest_ns, cpu.progress_ns);
  return furthest_ns;
}

// What need not be looked at in each step.
void Engine::LookAround() {
  const std::uint64_t begun_tsc = __rdtsc();
  if (IsInGrace() || begun_tsc < next_look_tsc_) return;
  LookAtDetector();
  if (options_.on_progress) ShowProgress();
  if (options_.on_notice) LookForStandstill();
  const std::uint64_t now_tsc = __rdtsc();
  const auto every = static_cast<std::uint64_t>(static_cast<double>(kLookEveryNs) * ticks_per_ns_);
  next_look_tsc_ = now_tsc + std::max(every, (now_tsc - begun_tsc) * kLookPause);
}

void Engine::ShowProgress() {
  RunProgress progress;
  progress.virtual_ns = world_.present() ? world_.progress_ns() : root_.Least();
  progress.real_ns = HostClockNs(CLOCK_MONOTONIC) - start_real_ns_;
  progress.drift_ns = std::max(root_.drift_ns(), most_lead_.ns());
  progress.client_ns = client_host_ns_;
  progress.dynamics_ns = world_.present() ? world_.host_ns() : 0;
  progress.coordinating_ns =
      HostClockNs(CLOCK_THREAD_CPUTIME_ID) - start_cpu_ns_ - progress.dynamics_ns;
  for (const Process& process : table_.processes()) {
    if (process.is_client) progress.clients.push_back({process.name, ChargedToAllOf(process)});
  }
  if (shows_++ % kShowsPerFlush == 0) FlushRecords();
  options_.on_progress(progress);
}

// All threads have said that they end; the kernel is about to end their processes. False once that
// is over.
bool Engine::AwaitDeaths() {
  for (int turn = 0; turn < kDeathTurns && table_.living() == 0 && !HasLaunchAhead(); ++turn) {
    const bool all_dead = std::all_of(table_.processes().begin(), table_.processes().end(),
                                      [](const Process& process) { return process.dead; });
    if (all_dead || IsGraceOver() || (stop_.asked() && !IsInGrace())) return false;
    PollEvents(kOutsidePollNs, {latest_ns_});
  }
  return table_.living() > 0 || HasLaunchAhead();
}

// Nobody acts by itself any more, and no world goes on: what is left of the run is idle time, which
// is jumped over. But those that the kernel has, or that compute without a call, may still come
// back: they get as much real time as there is virtual time left. False at the run's end.
bool Engine::AwaitOutside() {
  if (end_ns_ != shm::kNeverNs) {
    const Reactor::Found found = PollEvents(0, {latest_ns_});
    PollUnseen();
    if (found.wakes_others || root_.Least() != shm::kNeverNs) return true;
    if (unseen_ == 0 && !has_spinners_ && !AwaitsUnknownChildren() && !StrangersRun()) return false;
    const std::int64_t furthest_ns = FurthestNs(), now_ns = HostClockNs(CLOCK_MONOTONIC);
    if (std::exchange(idle_at_ns_, furthest_ns) != furthest_ns) idle_since_real_ns_ = now_ns;
    if (now_ns - idle_since_real_ns_ >= end_ns_ - furthest_ns) return false;
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
  ended_links_.clear();
  if (table_.living() == 0 && !HasLaunchAhead()) return AwaitDeaths();
  PollUnseen();
  LookAround();
  TakeOwnMessages();
  if (StepWorld()) return true;
  const std::int64_t least = root_.Least();
  if (least >= end_ns_ || least == shm::kNeverNs) {
    if (least == shm::kNeverNs && !WorldGoesOn() && AwaitOutside()) return true;
    reached_end_ = true;
    return false;
  }
  VirtualCpu& cpu = cpus_[static_cast<std::size_t>(root_.First())];
  const bool idle = cpu.robot->scheduler.Next(cpu.core).thread == RobotScheduler::kNobody;
  if (idle && !HasJumpedOver()) return true;
  // What was there may have made another one the least.
  if (root_.First() == cpu.leaf) StepCpu(cpu);
  return true;
}

RunReport Engine::Run() {
  for (const std::string& warning : scenario_.warnings) Warn(warning);
  report_.error = Prepare();
  if (report_.error.empty()) report_.error = StartClients();
  start_real_ns_ = HostClockNs(CLOCK_MONOTONIC);
  start_cpu_ns_ = HostClockNs(CLOCK_THREAD_CPUTIME_ID);
  start_tsc_ = __rdtsc();
  schedule_.StartAt(start_tsc_, ticks_per_ns_);
  try {
    while (report_.error.empty() && !stop_.asked()) {
      if (!Step()) break;
    }
  } catch (const DynamicsError& error) {
    report_.error = error.what();
  }
  report_.real_ns = HostClockNs(CLOCK_MONOTONIC) - start_real_ns_;
  report_.coordinating_ns = HostClockNs(CLOCK_THREAD_CPUTIME_ID) - start_cpu_ns_ -
                            (world_.present() ? world_.host_ns() : 0);
  Report(&report_);
  // First: what clients do at their end is no part of the run.
  if (std::string error = CloseRecords(); !error.empty() && report_.error.empty()) {
    report_.error = error;
  }
  RunReport report = report_;
  if (header_ != nullptr) {
    EndClients();
    Shutdown();
  }
  report.warnings = report_.warnings;
  return report;
}

RunReport RunScenario(const Scenario& scenario, const RunOptions& options) {
  return Engine(scenario, options).Run();
}

}  // namespace tcs
