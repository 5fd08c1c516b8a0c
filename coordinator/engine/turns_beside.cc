#include "coordinator/engine/turns_beside.h"

#include <xmmintrin.h>

#include <algorithm>

#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/guardian.h"
#include "coordinator/port/clocks.h"

namespace tcs {

namespace {

constexpr int kMostBegun = 4;
constexpr std::size_t kMostThreads = 16;  // of a robot: all of them are looked at each time
// So many turns in a row have to be so short before a turn is had beside; and twice as many each
// time that the thread then did what ends such a turn.
constexpr int kShortTurns = 3, kMostShortTurns = 256;
constexpr HostDuration kShortTurn = HostDuration::Microseconds(200);
// Between two looks, while a turn is waited for, at what the kernel has to say.
constexpr std::int64_t kLookBesideNs = 20'000;
// Others of the host may keep a thread from running for so long.
constexpr std::int64_t kPatienceNs = 1'000'000;

bool WaitsForTimeAtMost(const Task& task) {
  return task.state == TaskState::kReady || task.Awaits<awaited::Time>() != nullptr;
}

// Nothing is left of an earlier call of the thread, and nothing comes by itself.
bool IsUndisturbed(const Task& task) {
  return task.slot >= 0 && task.trap_id == 0 && task.after_call == AfterCall::kNone &&
         !task.owes_ahead && !task.notified_early && !task.early_trap.has_value() && !task.executes;
}

bool IsUndisturbed(const Process& process) {
  return process.dds_number == 0 && !process.has_unregistered_threads && !process.stopped &&
         !process.violates_protocol && !process.killed && process.timers.NextExpiry().IsNever() &&
         !process.timers.HasCpuTimers();
}

}  // namespace

void TurnsBeside::Open(int home, const std::vector<int>& further) {
  if (further.empty()) return;
  cpu_ = std::make_unique<BesideCpu>(further.front(), home, parts_.clock.rate().ticks_per_ns,
                                     parts_.executor, IsClaimed);
  parts_.run.header->turns_beside = 1;
}

bool TurnsBeside::MayBegin() {
  const RunState& run = parts_.run;
  return cpu_ != nullptr && cpu_->begun() < kMostBegun && !run.IsInGrace() &&
         run.options.debugged.empty() && cpu_->IsFreeAt(HostTsc());
}

bool TurnsBeside::MayBegin(const Robot& robot) {
  if (robot.cpus.size() != 1 || robot.is_ideal || robot.is_disturbed || robot.keeps_timer_signals ||
      !robot.next_launch.IsNever() || robot.tasks.size() > kMostThreads) {
    return false;
  }
  return std::ranges::all_of(robot.tasks, [](const Task* task) {
    return !task->turns_beside && WaitsForTimeAtMost(*task) && IsUndisturbed(*task) &&
           IsUndisturbed(*task->process);
  });
}

bool TurnsBeside::MayBegin(const Task& task) {
  return task.state == TaskState::kReady && task.parked && task.short_turns >= task.beside_after;
}

bool TurnsBeside::IsTaken() {
  if (!parts_.ahead.IsOn(cpu_->cpu())) return false;
  cpu_->NoteWanted(HostTsc());
  return true;
}

bool TurnsBeside::Begin(Task& task, VirtualTime horizon) {
  if (!cpu_->Begin(task)) return false;
  task.beside_horizon = horizon;
  parts_.records.BeganBeside(task);
  ++parts_.run.report.switches;
  ++parts_.run.report.turns_beside;
  return true;
}

bool TurnsBeside::IsOver(const Task& task) const {
  return !task.turns_beside || task.died_beside || task.early_trap.has_value() ||
         BesideCpu::HasSaid(task);
}

bool TurnsBeside::Await(Task& task) {
  Beat();
  const RunClock& clock = parts_.clock;
  const std::uint64_t begun_tsc = HostTsc(), look_ticks = clock.TicksIn(kLookBesideNs);
  const std::uint64_t until_tsc = begun_tsc + clock.TicksIn(kPatienceNs);
  std::uint64_t now_tsc = begun_tsc, look_tsc = begun_tsc + look_ticks;
  while (!IsOver(task) && now_tsc < until_tsc) {
    _mm_pause();
    now_tsc = HostTsc();
    if (now_tsc < look_tsc) continue;
    look_tsc = now_tsc + look_ticks;
    poll_({parts_.run.latest});
  }
  parts_.run.report.awaited_ns += clock.NsAt(now_tsc) - clock.NsAt(begun_tsc);
  if (!task.turns_beside) return false;  // the thread has ended
  if (!cpu_->GiveUp(task)) return true;
  parts_.records.EndsBeside(task);
  // Other threads have the processor, or this thread computes longer than expected.
  if (!task.early_trap.has_value() && !task.died_beside) {
    task.short_turns = 0;
    cpu_->LeaveToOthers(now_tsc);
  }
  cpu_->BringHome(task);
  return false;
}

void TurnsBeside::Take(Task& task) {
  cpu_->Take(task);
  parts_.records.EndsBeside(task);
}

bool TurnsBeside::NoteExitIn(const Process& process) {
  bool has_turn = false;
  for (Task* task : process.robot->tasks) {
    if (task->process != &process || !task->turns_beside) continue;
    task->died_beside = has_turn = true;
  }
  return has_turn;
}

void TurnsBeside::BringHome(Task& task) { cpu_->BringHome(task); }

void TurnsBeside::Forget(Task& task) {
  if (!task.turns_beside) return;
  cpu_->Forget(task);
  parts_.records.EndsBeside(task);
}

void TurnsBeside::NoteTurn(Task& task, bool beside) const {
  if (cpu_ == nullptr) return;
  const bool computes = task.ran >= kShortTurn || task.used_up >= Task::kComputes;
  // Where the dynamics have something for the robot by then, the thread has to hold wherever it
  // runs.
  const bool holds_for_others =
      task.state == TaskState::kHolding && OwnNow(task).ns() <= task.grant.local_read_safe_ns;
  const bool needs_its_order = holds_for_others || parts_.run.turn.trapped.has_value();
  if (beside) {
    task.beside_after =
        needs_its_order ? std::min(2 * task.beside_after, kMostShortTurns) : kShortTurns;
  }
  if (computes || needs_its_order) {
    task.short_turns = 0;
  } else if (task.Awaits<awaited::Time>() != nullptr) {
    ++task.short_turns;
  }
}

}  // namespace tcs
