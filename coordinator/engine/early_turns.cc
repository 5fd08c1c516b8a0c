#include "coordinator/engine/early_turns.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "coordinator/engine/turn_plan.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/os/trap.h"
#include "coordinator/port/clocks.h"
#include "coordinator/tasks/cpu_clock.h"

namespace tcs {

namespace {

// Shorter turns are not worth while.
constexpr VirtualDuration kLeastTurn = VirtualDuration::Microseconds(20);

}  // namespace

void EarlyTurns::Begin() {
  if (!all_.beside.MayBegin() || all_.outside.IsAwaited()) return;
  const VirtualTime least = run_.root.Least();
  const VirtualTime until =
      std::min({run_.root.NextOutput(), run_.end, AtMostNever(least, run_.scenario.drift_bound)});
  if (all_.world_leaf.GoesOn() && run_.root.DynamicsHorizon() < until) {
    all_.world.Lead(least, std::min(least, all_.world.NextStop()));
    run_.root.UpdateDynamics(all_.world.progress(), all_.world.NextOutput());
  }
  std::array<TemporalConsistency::Leaf, TurnsBeside::kMostLooks> leaves;
  const std::size_t count = run_.root.Soonest(until, leaves);
  for (std::size_t i = 1; i < count && all_.beside.MayBegin(); ++i) {
    if (leaves[i] == all_.network_leaf.leaf() || leaves[i] == all_.outside_leaf.leaf()) continue;
    BeginOn(run_.cpus[static_cast<std::size_t>(leaves[i])]);
  }
}

// The virtual CPU comes to its next turn, as it would do later, too, and has that turn.
void EarlyTurns::BeginOn(VirtualCpu& cpu) {
  Robot& robot = *cpu.robot;
  if (!TurnsBeside::MayBegin(robot)) return;
  const VirtualTime at = std::max(cpu.progress, robot.scheduler.NextActionOf(cpu.core));
  if (at > std::min(run_.root.Horizon(cpu.leaf), run_.root.DynamicsHorizon())) return;
  cpu.ComeTo(at);
  const VirtualTime latest = run_.latest;
  all_.timers.FireDue(robot, at);
  run_.latest = latest;
  robot.scheduler.EndTurn(cpu.core);
  all_.waker.Refresh(robot);
  const RobotScheduler::Turn turn = robot.scheduler.Next(cpu.core);
  if (turn.thread == RobotScheduler::kNobody || turn.start > at) return;
  Task& task = run_.table.At(turn.thread);
  if (!TurnsBeside::MayBegin(task)) return;
  task.cpu = &cpu;
  VirtualTime idle_until;
  const VirtualTime horizon =
      std::min(all_.horizons.Of(task, &idle_until), run_.root.DynamicsHorizon());
  if (horizon < at + kLeastTurn || OnlyPays(task.state, at, task.debt, horizon)) return;
  if (all_.beside.IsTaken()) return;
  task.ComeTo(at);
  all_.clock_pages.Write(task, horizon, std::min(idle_until, horizon));
  // Everything that others may see or have done has its order.
  task.grant.read_safe_ns = task.grant.write_safe_ns = -1;
  task.grant.NoteLimits();
  task.grant.WriteTo(SlotOf(task).clock);
  all_.host_cpu.StartBeside(task, HostTsc());
  if (all_.beside.Begin(task, horizon)) Dispatcher::NoteTurnBegins(task);
}

void EarlyTurns::Take(Task& task) {
  const bool has_said = all_.beside.Await(task);
  if (task.state == TaskState::kDead) return;
  const EventTime call{task.cpu->progress};
  run_.turn.Begin(task, task.beside_horizon);
  run_.turn.recorded_tsc = task.grant.base_tsc;
  if (has_said) {
    run_.turn.notified = true;
    all_.host_cpu.WokeAt(BesideCpu::StoppedAt(task));
    all_.beside.Take(task);
  } else {
    run_.turn.trapped = std::exchange(task.early_trap, std::nullopt);
    run_.turn.timed_out = !run_.turn.trapped.has_value();
    all_.host_cpu.Woke();
    // The thread's clock has counted on meanwhile. The clock of the process tells for a thread that
    // has died.
    const Process& process = *task.process;
    all_.host_cpu.Check(task, task.died_beside && process.threads == 1
                                  ? [pid = process.pid] { return ProcessCpuClockNs(pid); }
                                  : CpuClockOf(task));
  }
  if (task.died_beside) {
    all_.thread_exit.ProcessEnded(task.process->index, {task.reached});
    run_.turn.End();
    return;
  }
  all_.dispatcher.EndTurn(task);
  run_.report.ahead_ns += task.ran.ns();
  all_.host_cpu.Woke();
  all_.dispatcher.TellOthersOf(task, call, false);
  if (task.process->violates_protocol) {
    if (task.state != TaskState::kDead) all_.violations.AwaitExit(task);
    return;
  }
  if (const auto& trapped = run_.turn.trapped;
      trapped && (IsExecution(*trapped) || IsEnd(*trapped))) {
    // The kernel carries out that call in the next turn.
    task.executes = IsExecution(*trapped);
    task.trap_listener = trapped->listener;
    task.trap_id = trapped->id;
    task.trap_continues = task.parked = true;
  } else {
    all_.dispatcher.Answer(task);
  }
  all_.beside.NoteTurn(task, true);
}

}  // namespace tcs
