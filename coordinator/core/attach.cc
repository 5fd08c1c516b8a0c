// Births and deaths of threads and processes.
#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"

namespace tcs {

Task* Engine::AddTask(Process& process, pid_t tid, std::int64_t at_ns) {
  Task& task = table_.AddTask(tid);
  task.process = &process;
  task.parked = false;
  task.metered.speed = process.robot->speed;
  task.reached_ns = task.activation.release_ns = std::max(at_ns, waker_.EarliestWake());
  process.robot->tasks.push_back(&task);
  SchedulerOf(task).Add(task.order, process.priority);
  if (process.deadline_ns > 0) {
    SchedulerOf(task).SetClientDeadline(task.order, process.deadline_ns, task.reached_ns);
  }
  SetState(task, TaskState::kStarting);
  Refresh(*process.robot);
  return &task;
}

Task* Engine::NewTask(pid_t pid, pid_t parent, Robot* robot, const std::string& name, int priority,
                      std::int64_t deadline_ns, std::int64_t at_ns, const Process* maker) {
  Process& process = table_.AddProcess(pid);
  process.parent = parent;
  process.robot = robot;
  process.name = name;
  process.priority = priority;
  process.deadline_ns = deadline_ns;
  process.pidfd.Reset(OpenPidfd(pid));
  if (maker != nullptr) {
    process.client = maker->client;
    process.call_cost_ns = maker->call_cost_ns;
    process.allocation_cost_ns = maker->allocation_cost_ns;
    process.patch_vdso = maker->patch_vdso;
    process.dds_endpoints = maker->dds_endpoints;
    process.clock = maker->clock.Fork();
  }
  if (process.pidfd) {
    reactor_.Add(process.pidfd.get(), EPOLLIN, {Tag::kProcess, process.index});
  }
  Task* task = AddTask(process, pid, at_ns);
  // Children have no name of their own; their place in the order is the same in every run.
  const bool is_child = maker != nullptr || parent != getpid();
  task->is_further = is_child;
  task->row =
      records_.AddRow(robot->name, is_child ? fmt::format("{} #{}", name, task->order) : name);
  return task;
}

Task* Engine::AddThread(Process& process, pid_t tid, std::int64_t at_ns) {
  ++process.threads;
  Task* task = AddTask(process, tid, at_ns);
  task->is_further = true;
  task->row =
      records_.AddRow(process.robot->name, fmt::format("{} #{}", process.name, task->order));
  return task;
}

Task* Engine::NewChild(pid_t pid, pid_t parent, const Process& maker, std::int64_t at_ns) {
  return NewTask(pid, parent, maker.robot, maker.name, maker.priority, maker.deadline_ns, at_ns,
                 &maker);
}

// What the thread has had and done goes to its process.
void Engine::EndTask(Task& task, Moment moment) {
  Process& process = *task.process;
  usage_.Keep(task);
  task.cpu_clock_fd.Reset();
  if (task.slot >= 0) {
    report_.staleness_ns = std::max(report_.staleness_ns, SlotCheck::StalenessOf(task));
    process.link->FreeSlot(task.slot);
  }
  if (process.deliverer == &task) process.deliverer = nullptr;
  shared_events_.PassOn(task, moment);
  waker_.Leave(task);
  SetState(task, TaskState::kDead);
  objects_.Forget(task);
  SchedulerOf(task).Remove(task.order);
  task.parked = true;
  std::erase(task.process->robot->tasks, &task);
  host_cpu_.active().Ended(task);
  early_connections_.erase(task.tid);
  table_.TaskEnded(task);
  Refresh(*task.process->robot);
}

void Engine::ProcessEnded(std::size_t index, Moment moment) {
  Process& process = table_.ProcessAt(index);
  if (process.dead) return;
  if (turn_.IsIn(process)) {
    Settle(*turn_.task());
    moment.ns = turn_.task()->reached_ns;
  }
  process.dead = true;
  table_.ProcessEnded(process);
  process.ended_at_ns = moment.ns;
  const std::vector<Task*> threads = process.robot->tasks;
  for (Task* task : threads) {
    if (task->process != &process) continue;
    EndTask(*task, moment);
    locks_.WakeThoseWaitingFor(*task, moment);
  }
  UsageBook::Keep(process);
  process.timer_fds.clear();
  reactor_.Remove(process.pidfd.get());
  process.pidfd.Reset();
  if (process.link != nullptr) ended_links_.push_back(std::move(process.link));
  if (Process* parent = LivingProcess(process.parent); parent != nullptr) {
    parent->children_cpu_ns += process.ended.usage().charged_ns + process.children_cpu_ns;
    stops_.ChildChanged(*parent, process.pid, false, moment);
  }
  StartThoseAfter(process);
  objects_.WakeAll(moment);
  dds_.Leave(process, moment);
  if (!process.is_client) table_.GiveUp(process);
  const std::optional<int> status = WaitStatusOf(process.pid);
  if (!status.has_value()) return;  // its parent's to reap
  process.wait_status = *status;
  // Of several threads the last may still be at what LetDie says: those are reaped at the run's
  // end, when nobody here is at a real-time priority any more.
  if (process.threads == 1) waitpid(process.pid, nullptr, WNOHANG);
  if (index == 0) {
    report_.exit_status = WIFEXITED(*status) ? WEXITSTATUS(*status) : 128 + WTERMSIG(*status);
  }
}

}  // namespace tcs
