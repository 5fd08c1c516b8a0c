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

namespace {

constexpr std::size_t kKeptAfterEnd = 64;

}  // namespace

// The place of one that ended long enough ago, so that nobody speaks of it any more; else a new
// one.
Task& Engine::PlaceForTask() {
  if (ended_tasks_.size() > kKeptAfterEnd) {
    Task& task = *ended_tasks_.front();
    ended_tasks_.pop_front();
    const int order = task.order;
    task = Task{};
    task.order = order;
    return task;
  }
  Task& task = tasks_.emplace_back();
  task.order = static_cast<int>(tasks_.size() - 1);
  return task;
}

// The same. A child that has not been waited for keeps its place, and so does a client.
Process& Engine::PlaceForProcess() {
  if (ended_processes_.size() > kKeptAfterEnd) {
    Process& process = *ended_processes_.front();
    ended_processes_.pop_front();
    if (ThreadState(process.pid) != 'Z') {
      const std::uint32_t index = process.index;
      process = Process{};
      process.index = index;
      return process;
    }
    ended_processes_.push_back(&process);
  }
  Process& process = processes_.emplace_back();
  process.index = static_cast<std::uint32_t>(processes_.size() - 1);
  return process;
}

Task* Engine::AddTask(Process& process, pid_t tid, std::int64_t at_ns) {
  Task& task = PlaceForTask();
  ++living_;
  by_tid_[tid] = &task;
  task.process = &process;
  task.tid = tid;
  task.parked = false;
  task.metered.speed = process.robot->speed;
  task.reached_ns = task.activation.release_ns = std::max(at_ns, EarliestWake());
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
  Process& process = PlaceForProcess();
  process.pid = pid;
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
    process.frozen_ns = maker->frozen_ns;
    process.shown_ns = maker->shown_ns;
  }
  if (process.pidfd) {
    reactor_.Add(process.pidfd.get(), EPOLLIN, {Tag::kProcess, process.index});
  }
  Task* task = AddTask(process, pid, at_ns);
  // Children have no name of their own; their place in the order is the same in every run.
  const bool is_child = maker != nullptr || parent != getpid();
  task->is_further = is_child;
  task->row = AddRow(robot->name, is_child ? fmt::format("{} #{}", name, task->order) : name);
  return task;
}

Task* Engine::AddThread(Process& process, pid_t tid, std::int64_t at_ns) {
  ++process.threads;
  Task* task = AddTask(process, tid, at_ns);
  task->is_further = true;
  task->row = AddRow(process.robot->name, fmt::format("{} #{}", process.name, task->order));
  return task;
}

Process* Engine::LivingProcess(pid_t pid) {
  const auto found = std::find_if(processes_.begin(), processes_.end(),
                                  [pid](const Process& p) { return p.pid == pid && !p.dead; });
  return found == processes_.end() ? nullptr : &*found;
}

Task* Engine::KnownTask(pid_t tid) {
  const auto known = by_tid_.find(tid);
  return known == by_tid_.end() ? nullptr : known->second;
}

Task* Engine::NewChild(pid_t pid, pid_t parent, const Process& maker, std::int64_t at_ns) {
  return NewTask(pid, parent, maker.robot, maker.name, maker.priority, maker.deadline_ns, at_ns,
                 &maker);
}

// What the thread has had and done goes to its process.
void Engine::EndTask(Task& task, Moment moment) {
  Process& process = *task.process;
  KeepUsageOf(task);
  task.cpu_clock_fd.Reset();
  if (task.slot >= 0) {
    report_.staleness_ns = std::max(report_.staleness_ns, StalenessOf(task));
    process.link->FreeSlot(task.slot);
  }
  if (process.deliverer == &task) process.deliverer = nullptr;
  PassOn(task, moment);
  LeaveWait(task);
  SetState(task, TaskState::kDead);
  queues_.Forget(task.order);
  SchedulerOf(task).Remove(task.order);
  --living_;
  task.parked = true;
  std::erase(task.process->robot->tasks, &task);
  host_cpu_.active().Ended(task);
  by_tid_.erase(task.tid);
  ended_tasks_.push_back(&task);
  Refresh(*task.process->robot);
}

void Engine::ProcessEnded(std::size_t index, Moment moment) {
  Process& process = processes_[index];
  if (process.dead) return;
  if (turn_.IsIn(process)) {
    Settle(*turn_.task());
    moment.ns = turn_.task()->reached_ns;
  }
  process.dead = true;
  process.ended_at_ns = moment.ns;
  const std::vector<Task*> threads = process.robot->tasks;
  for (Task* task : threads) {
    if (task->process != &process) continue;
    EndTask(*task, moment);
    WakeThoseWaitingFor(*task, moment);
  }
  KeepUsageOf(process);
  process.timer_fds.clear();
  reactor_.Remove(process.pidfd.get());
  process.pidfd.Reset();
  if (process.link != nullptr) ended_links_.push_back(std::move(process.link));
  if (Process* parent = LivingProcess(process.parent); parent != nullptr) {
    parent->children_cpu_ns += process.ended.usage().charged_ns + process.children_cpu_ns;
    ChildChanged(*parent, process.pid, false, moment);
  }
  StartThoseAfter(process);
  WakeEveryQueue(moment);
  LeaveDds(process, moment);
  if (!process.is_client) ended_processes_.push_back(&process);
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
