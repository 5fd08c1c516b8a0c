#include "coordinator/tasks/spin_waits.h"

#include <algorithm>
#include <utility>

#include "coordinator/tasks/cpu_clock.h"
#include "shm/spin_streak.h"

namespace tcs {

namespace {

// A look at memory takes less, on a host as fast as the robot, and what a thread does once it has
// seen what it waits for mostly takes more. Under set costs the thread may read its clock, too.
constexpr std::int64_t kGapNs = 500;
// The host takes up to so long to stop a thread, and the thread is charged some of that.
constexpr std::int64_t kStopNs = 20'000;
// A busy host takes so long, unless the thread's CPU clock was asked. A thread that has seen what
// it waited for has not paused as often in its turn.
constexpr std::int64_t kLateStopNs = 120'000;

// Calls `found(cpu, task)` with what each other core of the thread's robot does next.
template <class Found>
void ForEachBeside(const RunState& run, const Task& task, const Found& found) {
  Robot& robot = *task.process->robot;
  for (const VirtualCpu* cpu : robot.cpus) {
    if (cpu == task.cpu) continue;
    const RobotScheduler::Turn& turn = robot.scheduler.Next(cpu->core);
    if (turn.thread == RobotScheduler::kNobody || turn.start > cpu->progress) continue;
    const Task& other = run.table.At(turn.thread);
    if (other.state == TaskState::kReady) found(*cpu, other);
  }
}

}  // namespace

std::uint32_t SpinWaits::GapFor(const RunState& run, const Process& process) {
  const Robot& robot = *process.robot;
  if (run.IsCallback() || robot.is_ideal) return 0;
  if (run.IsFixed()) {
    return static_cast<std::uint32_t>(kGapNs + process.call_cost.ns());
  }
  if (robot.cpus.size() == 1) return 0;
  return static_cast<std::uint32_t>(static_cast<double>(kGapNs) / std::min(1.0, robot.speed));
}

// Under set costs no thread comes to a horizon by computing, and where a thread is would depend on
// the host.
bool SpinWaits::AsksThreads(const RunState& run) {
  return !run.IsFixed() && !run.IsCallback() &&
         std::ranges::any_of(run.scenario.robots,
                             [](const RobotSpec& robot) { return robot.cores > 1; });
}

bool SpinWaits::IsToBeAsked(Task& task) const {
  if (task.used_up == 0 || task.parked || task.is_brief || task.executes ||
      SlotOf(task).spin.can_be_asked == 0 || run_.IsFixed() || run_.IsCallback() ||
      task.process->robot->cpus.size() == 1 || task.process->robot->is_ideal ||
      SlotOf(task).open_calls.load() != 0 || task.reached < task.asked_at + kAskEvery ||
      LeastThatActs(task).IsNever()) {
    return false;
  }
  task.asked_at = task.reached;
  return true;
}

bool SpinWaits::TurnEnds(Task& task, VirtualTime start) const {
  if (task.slot < 0 || task.state == TaskState::kDead || task.process->robot->cpus.size() == 1) {
    return false;
  }
  shm::ThreadSlot& slot = SlotOf(task);
  Robot& robot = *task.process->robot;
  const bool in_loop = std::exchange(slot.spin.in_loop, std::uint8_t{0}) != 0;
  if (in_loop) task.process->stays_close_until = task.reached + kClose;
  const std::optional<SpinWait> before = std::exchange(task.spin, std::nullopt);
  // A thread that yields may look at memory again, too.
  const bool yields = run_.turn.notified && slot.note.kind == shm::NotificationKind::kYield;
  const bool stopped = !run_.turn.HasSpoken() ||
                       (run_.turn.notified && slot.note.kind == shm::NotificationKind::kHorizon);
  const auto paused_within = [&](std::int64_t gap_ns, std::uint8_t least) {
    return shm::IsSpinning(slot.spin, OwnNow(task).ns(), slot.spin_gap_ns + gap_ns, least);
  };
  bool is_streak = paused_within(0, stopped ? std::uint8_t{1} : shm::SpinStreak::kSpins);
  if (!run_.turn.HasSpoken()) {
    is_streak = paused_within(kStopNs, 1) || paused_within(kLateStopNs, shm::SpinStreak::kSpins);
  }
  const bool spins = slot.spin_gap_ns != 0 && (yields || is_streak);
  const auto act = [&] {
    ++robot.acts;
    // If the thread was stopped, others may have waited for what it did at any time until then.
    const VirtualDuration debt = std::max(VirtualDuration(), task.debt);
    const VirtualTime acted =
        run_.turn.HasSpoken() ? task.reached : start + (task.reached + debt - start) / 2;
    task.process->acted_until = std::max(task.process->acted_until, acted);
  };
  if (!spins) {
    act();
    return in_loop;
  }
  const VirtualTime since = task.process->clock.RobotTimeOf(OwnTime(slot.spin.begun_ns));
  SpinWait& spin = task.spin.emplace();
  spin.since = std::min(since, task.reached);
  spin.only_yields = !is_streak;
  spin.is_first = slot.spin.pauses < 2;
  spin.was_stopped = stopped;
  spin.reads_clock = slot.spin.reads_clock != 0;
  // The thread may have acted before it has begun to spin.
  if (!before.has_value() || before->since != spin.since) act();
  spin.has_seen = robot.acts;
  return !before.has_value();
}

VirtualDuration SpinWaits::StepOf(const Task& task) {
  if (!task.spin.has_value()) return kLeastStep;
  if (task.spin->only_yields) return kMostStep;
  if (task.spin->reads_clock) return kLeastStep;
  return std::clamp((task.reached - task.spin->since) / 4, kLeastStep, kMostStep);
}

VirtualTime SpinWaits::LeastThatActs(const Task& task) const {
  VirtualTime least = VirtualTime::Never();
  ForEachBeside(run_, task, [&](const VirtualCpu& cpu, const Task& other) {
    const bool acts = !other.spin.has_value() || other.spin->has_seen != task.process->robot->acts;
    if (acts) least = std::min(least, cpu.progress);
  });
  return least;
}

VirtualTime SpinWaits::NextToWake(const Task& task) {
  VirtualTime next = VirtualTime::Never();
  const Robot& robot = *task.process->robot;
  for (const VirtualCpu* cpu : robot.cpus) {
    if (cpu != task.cpu) next = std::min(next, robot.scheduler.NextActionOf(cpu->core));
  }
  return next;
}

// Whether time passes that the thread has not computed.
bool SpinWaits::Passes(const Task& task) {
  return task.spin.has_value() && !task.spin->only_yields && !task.spin->was_stopped &&
         !task.spin->reads_clock && task.reached - task.spin->since <= kLong;
}

void SpinWaits::Pass(Task& task, VirtualDuration duration) {
  task.charged += duration;
  task.debt += duration;
  task.cpu->busy += duration;
  // The time that the thread's way to its gate has taken is part of that.
  if (const std::int64_t cpu_ns = HostClockOf(task); cpu_ns >= 0) {
    task.metered.host_origin_ns = cpu_ns - task.metered.OnHost(task.charged).ns();
  }
}

void SpinWaits::PassTime(Task& task) const {
  if (!Passes(task)) return;
  const VirtualTime least = LeastThatActs(task);
  if (least.IsNever()) return;
  // The thread has seen what the others have done by now. A sleeping thread may act when it wakes.
  const VirtualTime seen_until = std::min(least, NextToWake(task));
  const VirtualDuration seen = std::max(VirtualDuration(), seen_until - task.reached);
  Pass(task, seen + StepOf(task) / 2);
}

bool SpinWaits::IsBeforeItsLook(Task& task) const {
  const bool yields_again = task.spin.has_value() && task.spin->only_yields && !task.spin->is_first;
  if ((!Passes(task) && !yields_again) || !task.parked) return false;
  const VirtualTime looks = task.cpu->progress + std::max(VirtualDuration(), task.debt);
  const VirtualTime acted = task.process->acted_until;
  // Other threads that look, too, may act again and again.
  if (acted > looks && !std::exchange(task.spin->has_waited, true)) Pass(task, acted - looks);
  return task.debt > VirtualDuration();
}

VirtualTime SpinWaits::LimitOf(const Task& task) const {
  VirtualTime limit = VirtualTime::Never();
  const bool is_close = task.process->stays_close_until > task.cpu->progress;
  ForEachBeside(run_, task, [&](const VirtualCpu& cpu, const Task& other) {
    if (is_close && other.process == task.process) {
      const VirtualTime close = std::max(cpu.progress, task.cpu->progress) + kMostStep;
      limit = std::min(limit, close);
    }
    if (!other.spin.has_value()) return;
    const VirtualDuration step = StepOf(other);
    const VirtualTime looks =
        cpu.progress + std::max(VirtualDuration(), other.debt) + (Passes(other) ? step / 2 : step);
    limit = std::min(limit, std::max(looks, task.cpu->progress + kLeastStep));
  });
  return limit;
}

VirtualTime SpinWaits::EndOfSpin(const Task& task) const {
  const VirtualTime least = LeastThatActs(task);
  if (least.IsNever()) return least;
  const VirtualTime start = task.cpu->progress;
  const bool computes =
      task.spin.has_value() && (task.spin->reads_clock || task.reached - task.spin->since > kLong);
  return computes ? std::max(start, least) + StepOf(task) : start;
}

}  // namespace tcs
