#include "coordinator/engine/horizons.h"

#include <algorithm>

#include "coordinator/engine/turn_plan.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/scenario/patience.h"

namespace tcs {

VirtualTime Horizons::Of(Task& task, VirtualTime* idle_until) {
  const VirtualCpu& cpu = *task.cpu;
  const Robot& robot = *cpu.robot;
  *idle_until = {};
  const VirtualTime seen_by_spinners = all_.spins.LimitOf(task);
  task.metered.is_watched = !seen_by_spinners.IsNever() && !run_.is_unprivileged;
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
  // Each sleep is to last a wake-up longer, as the coordinator finds.
  *idle_until = robot.wakeup.IsNone() ? horizon.idle : VirtualTime();
  return horizon.run;
}

// A program that computes for as long as the run is to be, all at one instant of the world's, would
// have the world stand for ever. Short runs, too, may have long plans computed.
VirtualDuration Horizons::MostHeld() const {
  return run_.IsInGrace() ? Patience{}.held : PatienceOf(run_.scenario).held;
}

VirtualDuration Horizons::LeftToHold(const Task& task) const {
  const VirtualDuration held = task.process->clock.HeldAt(task.cpu->progress);
  return std::clamp(MostHeld() - held, VirtualDuration(), VirtualNs(shm::kMaxDispatchNs));
}

}  // namespace tcs
