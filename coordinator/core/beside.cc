// Turns on another processor: how they begin before their order, and end in it (turns_beside.h).
#include <x86gprintrin.h>

#include <algorithm>
#include <array>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/core/turn_plan.h"
#include "coordinator/os/host.h"
#include "coordinator/os/trap.h"
#include "coordinator/tasks/cpu_clock.h"

namespace tcs {

namespace {

// Shorter ones are not worth while.
constexpr VirtualDuration kLeastTurn = VirtualDuration::Microseconds(20);

}  // namespace

// Before the first virtual CPU acts: those that act soon after it, and need not wait for it.
void Engine::BeginTurnsBeside() {
  if (!beside_.MayBegin() || outside_.IsAwaited()) return;
  const VirtualTime least = run_.root.Least();
  const VirtualTime until =
      std::min({run_.root.NextOutput(), run_.end, AtMostNever(least, run_.scenario.drift_bound)});
  if (WorldGoesOn() && run_.root.DynamicsHorizon() < until) {
    world_.Lead(least, std::min(least, world_.NextStop()));
    run_.root.UpdateDynamics(world_.progress(), world_.NextOutput());
  }
  std::array<TemporalConsistency::Leaf, TurnsBeside::kMostLooks> leaves;
  const std::size_t count = run_.root.Soonest(until, leaves);
  for (std::size_t i = 1; i < count && beside_.MayBegin(); ++i) {
    if (leaves[i] == network_leaf_ || leaves[i] == outside_leaf_) continue;
    BeginTurnBeside(run_.cpus[static_cast<std::size_t>(leaves[i])]);
  }
}

// The virtual CPU comes to its next turn, which it would do later, too, and has it.
void Engine::BeginTurnBeside(VirtualCpu& cpu) {
  Robot& robot = *cpu.robot;
  if (!TurnsBeside::MayBegin(robot)) return;
  const VirtualTime at = std::max(cpu.progress, robot.scheduler.NextActionOf(cpu.core));
  if (at > std::min(run_.root.Horizon(cpu.leaf), run_.root.DynamicsHorizon())) return;
  cpu.ComeTo(at);
  const VirtualTime latest = run_.latest;
  timers_.FireDue(robot, at);
  run_.latest = latest;
  robot.scheduler.EndTurn(cpu.core);
  waker_.Refresh(robot);
  const RobotScheduler::Turn turn = robot.scheduler.Next(cpu.core);
  if (turn.thread == RobotScheduler::kNobody || turn.start > at) return;
  Task& task = run_.table.At(turn.thread);
  if (!TurnsBeside::MayBegin(task)) return;
  task.cpu = &cpu;
  VirtualTime idle_until;
  const VirtualTime horizon = std::min(HorizonFor(task, &idle_until), run_.root.DynamicsHorizon());
  if (horizon < at + kLeastTurn || OnlyPays(task.state, at, task.debt, horizon)) return;
  if (beside_.IsTaken()) return;
  task.ComeTo(at);
  WritePage(task, horizon, std::min(idle_until, horizon));
  // Whatever others may see or have done has its order.
  task.grant.read_safe_ns = task.grant.write_safe_ns = -1;
  task.grant.NoteLimits();
  task.grant.WriteTo(SlotOf(task).clock);
  host_cpu_.StartBeside(task, __rdtsc());
  if (beside_.Begin(task, horizon)) NoteTurnBegins(task);
}

// The turn has its order: it ends now, at the time at which its thread stopped.
void Engine::TakeTurnBeside(Task& task) {
  const bool has_said = beside_.Await(task);
  if (task.state == TaskState::kDead) return;
  const Moment call{task.cpu->progress};
  run_.turn.Begin(task, task.beside_horizon);
  run_.turn.recorded_tsc = task.grant.base_tsc;
  if (has_said) {
    run_.turn.notified = true;
    host_cpu_.WokeAt(BesideCpu::StoppedAt(task));
    beside_.Take(task);
  } else {
    run_.turn.trapped = std::exchange(task.early_trap, std::nullopt);
    run_.turn.timed_out = !run_.turn.trapped.has_value();
    host_cpu_.Woke();
    // Its clock has counted on meanwhile. Of a thread that has died its process's clock tells.
    const Process& process = *task.process;
    host_cpu_.Check(task, task.died_beside && process.threads == 1
                              ? [pid = process.pid] { return ProcessCpuClockNs(pid); }
                              : CpuClockOf(task));
  }
  if (task.died_beside) {
    deaths_.ProcessEnded(task.process->index, {task.reached});
    run_.turn.End();
    return;
  }
  EndTurn(task);
  run_.report.ahead_ns += task.ran.ns();
  host_cpu_.Woke();
  TellOthersOf(task, call, false);
  if (task.process->expelled) {
    if (task.state != TaskState::kDead) expulsion_.AwaitDeath(task);
    return;
  }
  if (const auto& trapped = run_.turn.trapped;
      trapped && (IsExecution(*trapped) || IsEnd(*trapped))) {
    // The kernel carries that out in the next turn.
    task.executes = IsExecution(*trapped);
    task.trap_listener = trapped->listener;
    task.trap_id = trapped->id;
    task.trap_continues = task.parked = true;
  } else {
    Answer(task);
  }
  beside_.NoteTurn(task, true);
}

}  // namespace tcs
