#include "coordinator/calls/signal_reach.h"

#include <algorithm>

namespace tcs {

bool ReachBySignal(RunState& run, Task& task, pid_t receiver) {
  if (run.header->turns_beside == 0) return false;
  const Process* process = receiver > 0 ? run.table.LivingProcess(receiver) : nullptr;
  bool reaches = false;
  for (Robot& robot : run.robots) {
    const bool is_own = &robot == task.process->robot;
    const bool is_other = process != nullptr && process->robot != &robot;
    if (is_own || is_other || robot.is_disturbed) continue;
    robot.is_disturbed = reaches = true;
    task.ComeTo(std::max(task.reached, robot.Furthest()));
  }
  return reaches;
}

}  // namespace tcs
