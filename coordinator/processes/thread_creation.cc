#include "coordinator/processes/thread_creation.h"

#include <fmt/format.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>

#include "coordinator/os/own_number.h"
#include "coordinator/port/pidfds.h"
#include "coordinator/processes/cpu_limit.h"

namespace tcs {

namespace {

// Further threads and processes have no name of their own; their place in the order is the same in
// every run.
std::string NumberedName(const Task& task) {
  return fmt::format("{} #{}", task.process->name, task.order);
}

bool IsByDeadline(const Scenario& scenario, const Robot& robot) {
  return robot.number > 0 && robot.number <= scenario.robots.size() &&
         scenario.robots[robot.number - 1].scheduler == SchedulerPolicy::kEarliestDeadlineFirst;
}

}  // namespace

Task& ThreadCreation::AddTask(Process& process, pid_t tid, VirtualTime at) {
  Task& task = run_.table.AddTask(tid);
  task.process = &process;
  task.own_tid = process.pid_namespace == 0 ? tid : OwnNumberOf(tid).number;
  task.parked = false;
  task.metered.speed = process.robot->speed;
  task.metered.is_ideal = process.robot->is_ideal;
  task.ComeTo(std::max(at, waker_.EarliestWake()));
  task.started_at = task.reached;
  if (tid == process.pid) process.started_at = task.reached;
  task.activation.release_ns = task.reached.ns();
  process.robot->tasks.push_back(&task);
  SchedulerOf(task).Add(task.order, process.priority);
  if (process.deadline > VirtualDuration()) {
    SchedulerOf(task).SetClientDeadline(task.order, process.deadline, task.reached);
  }
  waker_.SetState(task, TaskState::kStarting);
  waker_.Refresh(*process.robot);
  return task;
}

Process& ThreadCreation::AddProcess(pid_t pid, pid_t parent, Robot& robot) {
  Process& process = run_.table.AddProcess(pid);
  process.parent = parent;
  const OwnNumber own = OwnNumberOf(pid);
  process.own_pid = own.number;
  process.pid_namespace = own.pid_namespace;
  process.robot = &robot;
  process.timers.TellOfNextExpiry(
      [&robot, index = process.index] { robot.scheduler.ExpiryChanged(index); });
  process.pidfd.Reset(OpenPidfd(pid));
  if (process.pidfd) {
    reactor_.Add(process.pidfd.get(), EPOLLIN, {Tag::kProcess, process.index});
  }
  return process;
}

Task& ThreadCreation::AddClient(pid_t pid, Robot& robot, const ClientSpec& client, VirtualTime at) {
  Process& process = AddProcess(pid, getpid(), robot);
  process.is_client = true;
  process.client = &process;
  process.spec = &client;
  process.name = client.name;
  process.priority = client.priority;
  if (IsByDeadline(run_.scenario, robot)) process.deadline = client.deadline;
  process.call_cost = client.fixed_call_cost;
  process.allocation_cost = client.fixed_allocation_cost;
  process.patch_vdso = client.patch_vdso;
  process.leads_counter = client.cycle_counter == CycleCounter::kVirtual;
  process.dds_endpoints = client.dds == DdsTransport::kEndpoints;
  Task& task = AddTask(process, pid, at);
  task.row = records_.AddRow(robot.name, client.name);
  return task;
}

Task& ThreadCreation::AddChild(pid_t pid, pid_t parent, const Process& maker, VirtualTime at) {
  Process& process = AddProcess(pid, parent, *maker.robot);
  process.client = maker.client;
  process.name = maker.name;
  process.priority = maker.priority;
  process.deadline = maker.deadline;
  process.call_cost = maker.call_cost;
  process.allocation_cost = maker.allocation_cost;
  process.patch_vdso = maker.patch_vdso;
  process.leads_counter = maker.leads_counter;
  // The gateway's child speaks to programs by sockets.
  process.dds_endpoints = maker.dds_endpoints && !maker.robot->is_ours;
  process.clock = maker.clock.Fork();
  InheritCpuLimit(maker, process);
  Task& task = AddTask(process, pid, at);
  task.is_further = true;
  task.row = records_.AddRow(process.robot->name, NumberedName(task));
  return task;
}

Task& ThreadCreation::AddThread(Process& process, pid_t tid, VirtualTime at) {
  ++process.threads;
  Task& task = AddTask(process, tid, at);
  task.is_further = true;
  task.row = records_.AddRow(process.robot->name, NumberedName(task));
  return task;
}

}  // namespace tcs
