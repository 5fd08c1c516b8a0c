#include "coordinator/processes/grace.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <cstring>

#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/run_clock.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

// The real time that the grace may take: twice what all virtual CPUs take that compute all through
// it, and some to begin with. If somebody waits for the end, no more than the guardian allows for.
constexpr HostDuration kLeastReal = HostDuration::Seconds(2),
                       kMostRealIfAsked = HostDuration::Seconds(6);
constexpr double kMostRealFactor = 2.0;

VirtualDuration GraceOf(const Process& process) {
  if (process.client == nullptr) return ClientSpec{}.stop_grace;
  const ClientSpec& client = *process.client->spec;
  return client.stop_signal == SIGKILL ? VirtualDuration() : client.stop_grace;
}

}  // namespace

// A program alone is asked with the signal that its user has sent.
int Grace::StopSignalOf(const Process& process) const {
  if (run_.options.output_directory.empty() && run_.stop.asked()) return run_.stop.signal();
  return process.client == nullptr ? SIGTERM : process.client->spec->stop_signal;
}

void Grace::Begin() {
  began_ = RunClock::Now();
  LimitRealTime();
  run_.latest = run_.grace_began;
  for (const Process& process : run_.table.processes()) {
    if (process.dead) continue;
    kill(process.pid, StopSignalOf(process));
    if (ThreadState(process.pid) == 'T') kill(process.pid, SIGCONT);
    GrantDebtOf(process);
  }
  for (const auto& [pid, child] : unregistered_children_.living()) {
    const Process* parent = run_.table.LivingProcess(child.parent);
    kill(pid, parent == nullptr ? SIGTERM : StopSignalOf(*parent));
  }
  signalled_({.at = run_.grace_began, .from_outside = true});
}

// The time that a thread has computed out of its turn passes without the thread first, and would be
// most of its grace: where a tracer or a busy host held the coordinator up, say.
void Grace::GrantDebtOf(const Process& process) {
  VirtualDuration debt;
  for (const Task* task : process.robot->tasks) {
    if (task->process == &process) debt = std::max(debt, task->debt);
  }
  const VirtualDuration grace = GraceOf(process);
  if (debt <= VirtualDuration() || grace == VirtualDuration()) return;
  kill_times_[process.pid] = AtMostNever(run_.grace_began, grace + debt);
}

bool Grace::GoOnToNextKill() {
  if (run_.table.living() == 0 || IsOver()) return false;
  VirtualTime next = VirtualTime::Never();
  for (const Process& process : run_.table.processes()) {
    if (!process.dead && !process.killed) next = std::min(next, KillTimeOf(process));
  }
  if (next.IsNever()) return false;
  run_.end = next;
  run_.root.EndAt(next);
  return true;
}

void Grace::LimitRealTime() {
  VirtualDuration longest;
  for (const Process& process : run_.table.processes()) {
    if (!process.dead) longest = std::max(longest, GraceOf(process));
  }
  double speed = 0;
  for (const Robot& robot : run_.robots) {
    speed += robot.speed * static_cast<double>(robot.cpus.size());
  }
  const double computing_ns = kMostRealFactor * speed * static_cast<double>(longest.ns());
  HostDuration limit = kLeastReal + HostNs(static_cast<std::int64_t>(std::min(computing_ns, 1e18)));
  if (run_.stop.asked()) limit = std::min(limit, kMostRealIfAsked);
  timer_.Reset(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK));
  itimerspec when{};
  when.it_value = shm::ToTimespec(limit.ns());
  timerfd_settime(timer_.get(), 0, &when, nullptr);
  // A grace that nothing bounds is none.
  if (!reactor_.Add(timer_.get(), EPOLLIN, {Tag::kGraceRanOut})) RanOut();
}

void Grace::RanOut() {
  timer_.Reset();
  ran_out_ = true;
}

VirtualTime Grace::KillTimeOf(const Process& process) const {
  const auto later = kill_times_.find(process.pid);
  return later == kill_times_.end() ? AtMostNever(run_.grace_began, GraceOf(process))
                                    : later->second;
}

// Where the kernel has one of the process's threads, the rest of the process's grace in real time.
VirtualDuration Grace::LeftInRealTime(const Process& process) const {
  const auto& tasks = process.robot->tasks;
  const bool has_kernel = std::any_of(tasks.begin(), tasks.end(), [&process](const Task* task) {
    return task->process == &process && task->state == TaskState::kUnseen;
  });
  const VirtualDuration passed = VirtualNs((RunClock::Now() - began_).ns());
  return has_kernel ? std::max(VirtualDuration(), GraceOf(process) - passed) : VirtualDuration();
}

bool Grace::KillOverdue() {
  if (run_.table.living() == 0 || IsOver()) return false;
  run_.latest = run_.end;
  bool awaits = false;
  for (Process& process : run_.table.processes()) {
    if (process.dead || process.killed || KillTimeOf(process) > run_.end) continue;
    if (const VirtualDuration left = LeftInRealTime(process); left > VirtualDuration()) {
      kill_times_[process.pid] = AtMostNever(run_.end, left);
      awaits = true;
      continue;
    }
    WarnOfKill(process, "its stop_grace");
    process.killed = true;
    kill(process.pid, SIGKILL);
  }
  signalled_({run_.end});
  return awaits;
}

// If there was no time for the processes' graces: all processes that are left are killed.
void Grace::WarnOfThoseLeft() {
  if (!ran_out_) return;
  for (const Process& process : run_.table.processes()) {
    WarnOfKill(process, "the limit of real time for that");
  }
}

void Grace::WarnOfKill(const Process& process, const std::string& within) {
  if (process.dead || process.killed || !process.is_client || GraceOf(process) == VirtualDuration())
    return;
  run_.Warn(fmt::format(
      "{} was killed: after SIG{} it did not end within {} ({:.3f} s), and what it had "
      "not written is lost",
      process.name, sigabbrev_np(StopSignalOf(process)), within, GraceOf(process).seconds()));
}

}  // namespace tcs
