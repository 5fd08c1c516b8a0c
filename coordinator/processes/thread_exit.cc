#include "coordinator/processes/thread_exit.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <optional>

#include "coordinator/port/proc_files.h"
#include "coordinator/processes/slot_check.h"
#include "coordinator/tasks/cpu_clock.h"

namespace tcs {

void ThreadExit::End(Task& task, EventTime when) {
  Process& process = *task.process;
  usage_.Keep(task);
  task.cpu_clock_fd.Reset();
  task.creations.clear();
  if (task.slot >= 0) {
    std::int64_t& stalest_ns = run_.report.staleness_ns;
    stalest_ns = std::max(stalest_ns, SlotCheck::StalenessOf(task));
    process.link->FreeSlot(task.slot);
  }
  if (process.deliverer == &task) process.deliverer = nullptr;
  listeners_.thread_ends(task, when);
  waker_.Leave(task);
  waker_.SetState(task, TaskState::kDead);
  listeners_.thread_has_ended(task);
  SchedulerOf(task).Remove(task.order);
  task.parked = true;
  std::erase(process.robot->tasks, &task);
  cpu_.active().Ended(task);
  run_.table.TaskEnded(task);
  waker_.Refresh(*process.robot);
}

void ThreadExit::EndAndWake(Task& task, EventTime when) {
  End(task, when);
  listeners_.wake_those_waiting_for(task, when);
}

void ThreadExit::EndThreadsOf(const Process& process, const Task* except, EventTime when) {
  const std::vector<Task*> threads = process.robot->tasks;
  for (Task* task : threads) {
    if (task->process == &process && task != except) EndAndWake(*task, when);
  }
}

bool ThreadExit::EndThreadsLostInExec(pid_t pid, EventTime when) {
  Task* first = run_.table.Living(pid);
  Process* of = run_.table.LivingProcess(pid);
  if (of == nullptr || of->threads == 1) return true;
  const std::vector<Task*>& threads = of->robot->tasks;
  const bool lives_on = std::any_of(threads.begin(), threads.end(), [&](const Task* task) {
    return task->process == of && task != first && IsThreadOf(pid, task->tid) &&
           !IsDying(task->tid);
  });
  if (lives_on) return false;
  const bool by_another = run_.turn.IsIn(*of) && run_.turn.task() != first;
  if (by_another) {
    listeners_.settle(*run_.turn.task());
    when.at = run_.turn.task()->reached;
  }
  EndThreadsOf(*of, first, when);
  of->has_unregistered_threads = false;
  if (first == nullptr || !by_another) return true;
  of->ended.NoteChangedClocks();
  // The processor clock under the first thread's number is another thread's from now on.
  first->cpu_clock_fd.Reset();
  first->metered.host_origin_ns = HostClockOf(*first) - first->metered.OnHost(first->charged).ns();
  return true;
}

void ThreadExit::ProcessEnded(std::uint32_t index, EventTime when) {
  Process& process = run_.table.ProcessAt(index);
  if (process.dead) return;
  if (run_.turn.IsIn(process)) {
    listeners_.settle(*run_.turn.task());
    when.at = run_.turn.task()->reached;
  }
  process.dead = true;
  if (process.asked_for_io_uring) TellOfRefusal(process);
  run_.table.ProcessEnded(process);
  process.ended_at = when.at;
  EndThreadsOf(process, nullptr, when);
  UsageBook::Keep(process);
  process.timer_fds.clear();
  process.broker.reset();
  reactor_.Remove(process.pidfd.get());
  process.pidfd.Reset();
  if (process.link != nullptr) ended_links_.push_back(std::move(process.link));
  if (Process* parent = run_.table.LivingProcess(process.parent); parent != nullptr) {
    const VirtualDuration charged =
        VirtualNs(process.ended.usage().charged_ns) + process.children_cpu;
    parent->children_cpu += charged;
    parent->ended_children.Ended(process.pid, charged.ns());
    listeners_.child_has_ended(*parent, process.pid, when);
  }
  listeners_.process_has_ended(process, when);
  if (!process.is_client) run_.table.GiveUp(process);
  Reap(process);
}

// Most programs that are refused io_uring do without. A program that fails then may have failed for
// that.
void ThreadExit::TellOfRefusal(const Process& process) const {
  const int status = EndOf(process.pid).value_or(0);
  const bool gave_up = WIFEXITED(status) ? WEXITSTATUS(status) != 0 : WTERMSIG(status) == SIGABRT;
  if (!gave_up) return;
  run_.Warn(fmt::format(
      "{} asked for io_uring, which tcs refuses (ENOSYS, as a kernel without it does), and failed; "
      "if that is why, have it use threads or epoll instead",
      process.client->name));
}

// Reaps the process if it is the coordinator's own child.
void ThreadExit::Reap(Process& process) {
  const std::optional<int> status = WaitStatusOf(process.pid);
  if (!status.has_value()) return;  // the parent is to reap it
  process.wait_status = *status;
  // Of several threads the last may still be at what KernelBlockedThreads::LetDie says: such
  // processes are reaped at the run's end, when no thread here is at a real-time priority any more.
  if (process.threads == 1) waitpid(process.pid, nullptr, WNOHANG);
  if (process.index == 0) {
    run_.report.exit_status = WIFEXITED(*status) ? WEXITSTATUS(*status) : 128 + WTERMSIG(*status);
  }
}

}  // namespace tcs
