#include "coordinator/engine/loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "coordinator/engine/turn_plan.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/port/clocks.h"
#include "coordinator/scenario/patience.h"
#include "coordinator/text/spoken.h"
#include "shm/check.h"

namespace tcs {

// The virtual CPU of an ideal robot has been at this instant for long, of real time, though its
// threads stop and go on: these threads may be answering each other for ever.
bool Loop::StandsForEver(VirtualCpu& cpu) const {
  const HostTime now = all_.pacing.RunningTime();
  if (std::exchange(cpu.stands_at, cpu.progress) != cpu.progress) cpu.stands_since = now;
  return now - cpu.stands_since > PatienceOf(run_.scenario).ideal;
}

// The thread stays where it is, and the world goes on to the end.
void Loop::LetWorldGoOnWithout(Task& task) {
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
                    task.process->name, Spoken(all_.horizons.MostHeld().ns()), at_s));
  }
  all_.host_cpu.active().Hold(task);
  task.ComeTo(task.cpu->progress);
  all_.waker.Wait(task, {awaited::Nothing{}});
  all_.waker.Refresh(*task.process->robot);
}

// The thread's clock has shown so much of the time to come already: that time passes without the
// thread.
void Loop::PayDebt(Task& task, VirtualDuration passes) {
  task.debt -= passes;
  if (run_.IsCallback()) {
    ProgramClock& clock = task.process->clock;
    clock.Advance(task.cpu->progress, passes);
    task.lead = clock.lead();
    return;
  }
  const VirtualTime start = task.cpu->progress;
  task.cpu->ComeTo(start + std::max(VirtualDuration(), passes));
  task.ComeTo(task.cpu->progress);
  const ProgramClock& clock = task.process->clock;
  run_.turn.recorded_tsc = HostTsc();  // the paid debt takes no real time
  all_.records.Ran(task, {clock.At(start), clock.At(task.reached)}, {start, task.reached},
                   run_.turn.recorded_tsc);
}

void Loop::StepCpu(VirtualCpu& cpu) {
  Robot& robot = *cpu.robot;
  if (!all_.ahead.IsNextOn(cpu)) cpu.ComeTo(std::max(cpu.progress, run_.root.Least()));
  const EventTime due{.at = cpu.progress, .from_outside = true};
  if (all_.timers.FireDue(robot, due.at)) all_.event_pump.Poll(EventPump::kNoWait, due);
  all_.gate_keeper.AwaitHandlers();
  all_.launches.StartDue(robot, cpu.progress);
  robot.scheduler.EndTurn(cpu.core);
  all_.waker.Refresh(robot);
  const RobotScheduler::Turn turn = robot.scheduler.Next(cpu.core);
  // An event that was due may have woken a thread that acts on another virtual CPU first; and more
  // may be due here before the turn begins.
  if (turn.start > cpu.progress || run_.root.First() != cpu.leaf) return;
  Task& task = run_.table.At(turn.thread);
  TCS_CHECK(task.reached <= cpu.progress);  // no thread runs before what has made it ready
  task.cpu = &cpu;
  ProgramClock& clock = task.process->clock;
  if (run_.IsCallback()) clock.LetWorldCatchUp(cpu.progress);
  TCS_CHECK(all_.waker.IsSafe(task));
  if ((run_.IsCallback() && all_.horizons.LeftToHold(task) == VirtualDuration()) ||
      (robot.is_ideal && StandsForEver(cpu))) {
    LetWorldGoOnWithout(task);
    return;
  }
  if (!task.parked && !task.owes_ahead && !task.turns_beside)
    all_.gate_keeper.ChargeUndispatched(task);
  all_.dds.ChargeForDue(task);
  VirtualTime idle_until;
  const VirtualTime start = cpu.progress;
  const VirtualDuration lead = clock.lead();
  VirtualTime horizon =
      task.turns_beside ? task.beside_horizon : all_.horizons.Of(task, &idle_until);
  if (!task.turns_beside &&
      GivesWay(start, horizon, run_.root.NextInput(cpu.leaf), run_.root.HasGivenWay(cpu.leaf))) {
    run_.root.GiveWay(cpu.leaf);
    return;
  }
  task.ComeTo(cpu.progress);
  run_.root.FirstActs();
  robot.scheduler.Dispatch(cpu.core, task.order);
  if (!task.turns_beside) horizon = all_.world_leaf.KeepNear(task, horizon);
  idle_until = std::min(idle_until, horizon);
  // Time that passes only in waiting needs none to be left.
  if (robot.is_ideal) horizon = std::max(horizon, start + VirtualNs(1));
  if (task.turns_beside) {
    all_.early_turns.Take(task);
  } else if (all_.ahead.TakeTurn(task, horizon)) {
    // The thread has computed that already.
  } else if (OnlyPays(task.state, start, task.debt, horizon) || all_.spins.IsBeforeItsLook(task)) {
    PayDebt(task, std::min(task.debt, horizon - start));
  } else {
    all_.dispatcher.Dispatch(task, horizon, idle_until);
    all_.ahead.SendIfItComputes(task);
    if (all_.gate_keeper.TakePutOff({run_.latest}).looks_again)
      all_.event_pump.Poll(EventPump::kNoWait, {run_.latest});
    all_.registration.RegisterUnannounced({run_.latest});
    all_.trap_receiver.TakeCallsOfNewborns({run_.latest});
    if (all_.spinners.any() && !task.spins) all_.spinners.Wake();
  }
  const VirtualDuration advanced = cpu.progress - start;
  robot.scheduler.Stop(cpu.core, advanced, advanced + (clock.lead() - lead));
  all_.waker.Requeue(task);
  all_.waker.Refresh(robot);
  TCS_CHECK(run_.IsCallback() || run_.root.drift() <= run_.scenario.drift_bound);
}

bool Loop::Step() {
  all_.thread_exit.DropLinks();
  if (all_.idle_time.Living() == 0 && !all_.launches.AreAhead()) return all_.idle_time.AwaitExits();
  if (all_.debugger.Holds()) {
    all_.idle_time.WaitForDebugger();
    return true;
  }
  all_.gate_keeper.AwaitHandlers();
  all_.unseen_threads.Poll();
  all_.lookout.Look();
  all_.dds.TakeOwnMessages();
  all_.ahead.Look();
  if (all_.outside.TakeRested()) all_.outside_leaf.LookAgainAtHidden();
  if (all_.outside.IsAwaited() || all_.outside_leaf.is_shown()) all_.outside_leaf.Update();
  // People who watch a run that stands at its start see where everything is.
  if (all_.pacing.IsOn() && all_.world.present() && all_.world.NextStop() == VirtualTime() &&
      all_.world_leaf.Step())
    return true;
  if (!all_.pace_keeper.Keep() || all_.world_leaf.Step() || all_.network_leaf.Step() ||
      all_.outside_leaf.Step())
    return true;
  const VirtualTime least = run_.root.Least();
  if (least >= run_.end || least.IsNever()) {
    if (least.IsNever() && !all_.world_leaf.GoesOn() && all_.idle_time.AwaitOutside()) return true;
    reached_end_ = true;
    return false;
  }
  all_.early_turns.Begin();
  VirtualCpu& cpu = run_.cpus[static_cast<std::size_t>(run_.root.First())];
  const bool idle = cpu.robot->scheduler.Next(cpu.core).thread == RobotScheduler::kNobody;
  if (idle && !all_.idle_time.HasJumpedOver()) return true;
  // An event that was there may have made another virtual CPU the least.
  if (run_.root.First() == cpu.leaf) StepCpu(cpu);
  return true;
}

}  // namespace tcs
