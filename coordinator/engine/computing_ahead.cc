#include "coordinator/engine/computing_ahead.h"

#include <xmmintrin.h>

#include <algorithm>

#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/cpu_places.h"
#include "coordinator/os/guardian.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/cpu_clock.h"

namespace tcs {

namespace {

// Other threads of the process see a thread's changes of shared memory so much too early at most.
constexpr VirtualDuration kMostAhead = VirtualDuration::Milliseconds(1);
// For kLong of computed time the way there and back was worth while, and for kShort it was not.
constexpr VirtualDuration kLong = VirtualDuration::Milliseconds(3),
                          kShort = VirtualDuration::Milliseconds(1);
constexpr int kMostComputes = 256;
// Between two looks, while a thread is waited for, at what the kernel has to say, and at its state.
constexpr std::int64_t kLookNs = 3'000, kStateLookNs = 200'000;
// For less uncertain time the coordinator does not ask how far a thread has come.
constexpr VirtualDuration kWorthAsking = VirtualDuration::Microseconds(20);

}  // namespace

std::vector<int> ComputingAhead::CpusBeside(int home, const RunState& run) {
  const bool helps = !run.IsFixed() && !run.IsCallback() && !run.is_unprivileged;
  return helps ? CpusBesideHome(home, run.options.host_cpus) : std::vector<int>{};
}

void ComputingAhead::Open(int home, const std::vector<int>& further, const BesideCpu* beside) {
  beside_ = beside;
  for (const int cpu : further) {
    cpus_.emplace_back(cpu, home, parts_.clock.rate().ticks_per_ns, parts_.executor, IsClaimed);
  }
}

bool ComputingAhead::MaySend(const Task& task) const {
  if (task.used_up < task.ahead_after || task.slot < 0) return false;
  if (task.state != TaskState::kReady || task.parked) return false;
  const Process& process = *task.process;
  const bool is_ordinary = ParametersOf(task).policy == SCHED_OTHER &&
                           process.deadline == VirtualDuration() && !process.robot->is_ideal &&
                           !process.timers.HasCpuTimers();
  const bool is_busy_otherwise =
      task.is_brief || task.executes || task.is_adopted || task.spins || task.is_deliverer ||
      task.notified_early || task.early_trap.has_value() || process.violates_protocol ||
      process.stopped || process.stays_home || stays_home_ || parts_.run.IsInGrace();
  // A thread that was stopped in the midst of a call would do to others, in no turn, what it is
  // about to do.
  const bool is_in_call = SlotOf(task).open_calls.load() != 0;
  return is_ordinary && !is_busy_otherwise && !is_in_call;
}

void ComputingAhead::SendIfItComputes(Task& task) {
  if (cpus_.empty() || !MaySend(task)) return;
  const std::uint64_t tsc = HostTsc();
  const auto cpu = std::find_if(cpus_.begin(), cpus_.end(), [&](const FurtherCpu& one) {
    const bool is_busy =
        beside_ != nullptr && beside_->cpu() == one.cpu() && beside_->IsBusyAt(tsc);
    return !is_busy && one.IsFreeAt(tsc);
  });
  if (cpu == cpus_.end() || ThreadState(task.tid) != 'R') return;
  const std::int64_t cpu_ns = HostClockOf(task);
  if (cpu_ns < 0) return;  // the thread is about to end
  // The thread computed that time here.
  parts_.run.ChargeAsDebt(task, task.metered.ChargeAt(cpu_ns) - task.charged);
  // The way there and back takes its time, too.
  const VirtualDuration most = MostAhead();
  if (task.debt > most / 2) return;
  ClockGrant& grant = task.grant;
  grant.counts_work |= shm::kIsAhead;
  SlotOf(task).clock.counts_work = grant.counts_work;
  task.ahead_from = task.charged;
  if (!cpu->Send(task, tsc, task.metered.OnHost(most - task.debt).ns())) return;
  parts_.cpu.active().Ended(task);
  if (!std::exchange(task.owes_ahead, true)) owing_.push_back(&task);
}

FurtherCpu& ComputingAhead::CpuOf(const Task& task) {
  return *std::find_if(cpus_.begin(), cpus_.end(),
                       [&](const FurtherCpu& cpu) { return cpu.thread() == &task; });
}

bool ComputingAhead::IsOn(int number) const {
  return std::ranges::any_of(cpus_, [number](const FurtherCpu& cpu) {
    return cpu.cpu() == number && cpu.thread() != nullptr;
  });
}

VirtualDuration ComputingAhead::MostAhead() const {
  return std::min(kMostAhead, parts_.run.scenario.drift_bound);
}

void ComputingAhead::HasSpoken(Task& task) {
  if (!task.is_ahead) return;
  BringHome(task);
  const VirtualDuration computed = task.charged - task.ahead_from;
  if (computed > kLong) task.ahead_after = Task::kComputes;
  if (computed < kShort) task.ahead_after = std::min(2 * task.ahead_after, kMostComputes);
}

// The thread stands still, so that its CPU clock is right.
void ComputingAhead::BringHome(Task& task) {
  CpuOf(task).BringHome();
  if (const std::int64_t cpu_ns = HostClockOf(task); cpu_ns >= 0) {
    Charge(task, task.metered.ChargeAt(cpu_ns));
  }
}

VirtualTime ComputingAhead::EndOfDebt(const Process& process) const {
  VirtualTime end;
  for (const Task* task : owing_) {
    if (task->process == &process) end = task->cpu->progress + task->debt;
  }
  return end;
}

void ComputingAhead::StayHome(Process* process) {
  bool& stays = process != nullptr ? process->stays_home : stays_home_;
  if (std::exchange(stays, true)) return;
  for (Task* task : owing_) {
    if (task->is_ahead && (process == nullptr || task->process == process)) BringHome(*task);
  }
}

void ComputingAhead::BringHomeHolders(const Process& process, bool long_held) {
  for (Task* task : owing_) {
    if (!task->is_ahead || task->process != &process) continue;
    if (long_held || CpuOf(*task).HasLeft()) BringHome(*task);
  }
}

void ComputingAhead::MakeRoomForHelpers() {
  for (FurtherCpu& cpu : cpus_) cpu.LetNobodyRest();
}

void ComputingAhead::Forget(const Task& task) {
  if (task.is_ahead) CpuOf(task).BringHome();
  std::erase(owing_, &task);
}

// `charged`: the thread's charge in all.
void ComputingAhead::Charge(Task& task, VirtualDuration charged) {
  parts_.run.report.ahead_ns += parts_.run.ChargeAsDebt(task, charged - task.charged).ns();
}

// Time that others may have taken of the thread's processor is not charged: the world would go past
// what the thread does next.
void ComputingAhead::ChargeAhead(Task& task) {
  Charge(task, task.ahead_from + task.metered.OnRobot(HostNs(CpuOf(task).Computed())));
}

// The time that the thread may have computed besides.
VirtualDuration ComputingAhead::Uncertain(const Task& task) {
  const std::int64_t host_ns = CpuOf(task).MayHaveComputedBy(HostTsc());
  return task.ahead_from + task.metered.OnRobot(HostNs(host_ns)) - task.charged;
}

void ComputingAhead::AskHowFar(Task& task) {
  CpuOf(task).HaveLooked();
  ChargeAhead(task);
}

bool ComputingAhead::IsNextOn(const VirtualCpu& cpu) const {
  const RobotScheduler::Turn& turn = cpu.robot->scheduler.Next(cpu.core);
  return turn.thread != RobotScheduler::kNobody && turn.start <= cpu.progress &&
         parts_.run.table.At(turn.thread).owes_ahead;
}

VirtualTime ComputingAhead::EndOfDebt(const VirtualCpu& cpu) const {
  if (owing_.empty() || !IsNextOn(cpu)) return {};
  const Robot& robot = *cpu.robot;
  const Task& task = parts_.run.table.At(robot.scheduler.Next(cpu.core).thread);
  if (task.debt <= VirtualDuration()) return {};
  const VirtualDuration ahead = std::min(task.debt, parts_.run.scenario.drift_bound);
  const VirtualTime paid = std::min(robot.next_launch, cpu.progress + ahead);
  return robot.scheduler.HorizonOf(cpu.core, task.order, paid, {}).run;
}

void ComputingAhead::Look() {
  for (Task* task : owing_) {
    if (!task->is_ahead) continue;
    ChargeAhead(*task);
    // The others wait for this thread alone.
    const bool is_least = parts_.run.root.First() == task->cpu->leaf;
    if (is_least && Uncertain(*task) >= kWorthAsking) AskHowFar(*task);
    parts_.waker.Refresh(*task->process->robot);
  }
}

bool ComputingAhead::TakeTurn(Task& task, VirtualTime horizon) {
  if (!task.owes_ahead) return false;
  parts_.run.turn.recorded_tsc = HostTsc();  // the paid debt takes no real time before the turn
  if (task.is_ahead) {
    Await(task, horizon);
  } else if (task.debt <= VirtualDuration()) {
    task.owes_ahead = false;
    std::erase(owing_, &task);
    return false;
  }
  // A thread that was woken meanwhile is not to be left behind further than the drift bound.
  Pay(task, std::min(horizon, parts_.run.root.Horizon(task.cpu->leaf)));
  if (!task.is_ahead) SendIfItComputes(task);
  ++task.process->changes.turns;
  return true;
}

// Waits until the thread has computed up to the horizon or has said something, or others have
// something to do.
void ComputingAhead::Await(Task& task, VirtualTime horizon) {
  RunState& run = parts_.run;
  FurtherCpu& cpu = CpuOf(task);
  run.latest = std::max(task.cpu->progress, run.root.Least());
  Beat();
  const std::uint64_t begun_tsc = run.turn.recorded_tsc;
  std::uint64_t looks_tsc = begun_tsc + parts_.clock.TicksIn(kStateLookNs);
  for (;;) {
    const PollOutcome found = poll_({run.latest});
    if (found.stops_running || found.wakes_others || !task.is_ahead) break;
    ChargeAhead(task);
    const VirtualDuration to_go = horizon - task.cpu->progress;
    if (task.debt < to_go && task.debt + Uncertain(task) >= to_go) AskHowFar(task);
    // A thread that rests goes on as soon as it has paid.
    if (task.debt >= to_go || cpu.Rests()) break;
    const std::uint64_t now_tsc = HostTsc();
    const bool looks = now_tsc >= looks_tsc;
    if (looks) looks_tsc = now_tsc + parts_.clock.TicksIn(kStateLookNs);
    const bool is_starved = cpu.IsStarvedBy(now_tsc);
    if (is_starved) cpu.LeaveToOthers(now_tsc);
    // The kernel may hold the thread.
    if (is_starved || cpu.HasLeft() || (looks && ThreadState(task.tid) != 'R')) {
      BringHome(task);
      break;
    }
    const std::uint64_t until_tsc = now_tsc + parts_.clock.TicksIn(kLookNs);
    while (HostTsc() < until_tsc) _mm_pause();
  }
  run.report.awaited_ns += parts_.clock.NsAt(HostTsc()) - parts_.clock.NsAt(begun_tsc);
}

void ComputingAhead::Pay(Task& task, VirtualTime horizon) {
  constexpr VirtualDuration kNone;
  const VirtualTime start = task.cpu->progress;
  const VirtualDuration paid = std::clamp(task.debt, kNone, std::max(kNone, horizon - start));
  if (task.state == TaskState::kDead || paid == kNone) return;
  const VirtualTime end = start + paid;
  task.debt -= paid;
  task.cpu->ComeTo(end);
  // The thread may have waited since then, and have been woken where others have come further.
  task.ComeTo(std::max(task.reached, end));
  parts_.run.latest = end;
  const ProgramClock& clock = task.process->clock;
  parts_.records.Ran(task, {clock.At(start), clock.At(end)}, {start, end}, HostTsc());
  if (!task.is_ahead) return;
  const VirtualDuration paid_in_all = task.charged - task.ahead_from - task.debt;
  CpuOf(task).Allow(task.metered.OnHost(paid_in_all + MostAhead()).ns());
}

}  // namespace tcs
