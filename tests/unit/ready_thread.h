// A thread that is a number, the only one of its process, and ready on its robot's first core.
#pragma once

#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

inline Task& AddReadyThread(RunState& run, Waker& waker, Robot& robot, int number) {
  Process& process = run.table.AddProcess(number);
  process.robot = &robot;
  process.client = &process;
  Task& task = run.table.AddTask(number);
  task.process = &process;
  task.cpu = robot.cpus[0];
  robot.tasks.push_back(&task);
  robot.scheduler.Add(task.order, 0);
  waker.SetState(task, TaskState::kReady);
  waker.Refresh(robot);
  return task;
}

}  // namespace tcs
