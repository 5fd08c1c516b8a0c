#include "coordinator/processes/grace.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <cstring>

#include "coordinator/os/host.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

// What real time the grace may take: twice what all virtual CPUs take that compute all through it,
// and some to begin with. If somebody waits for the end, no more than the guardian allows for.
constexpr std::int64_t kLeastRealNs = 2'000'000'000, kMostRealIfAskedNs = 6'000'000'000;
constexpr double kMostRealFactor = 2.0;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

std::int64_t GraceOf(const Process& process) {
  if (process.client == nullptr) return ClientSpec{}.stop_grace.ns();
  const ClientSpec& client = *process.client->spec;
  return client.stop_signal == SIGKILL ? 0 : client.stop_grace.ns();
}

}  // namespace

// What a program alone is asked with is what its user has sent.
int Grace::StopSignalOf(const Process& process) const {
  if (run_.options.output_directory.empty() && run_.stop.asked()) return run_.stop.signal();
  return process.client == nullptr ? SIGTERM : process.client->spec->stop_signal;
}

void Grace::Begin() {
  LimitRealTime();
  run_.latest_ns = run_.grace_began_ns;
  for (const Process& process : run_.table.processes()) {
    if (process.dead) continue;
    kill(process.pid, StopSignalOf(process));
    if (ThreadState(process.pid) == 'T') kill(process.pid, SIGCONT);
  }
  for (const auto& [pid, child] : unknown_children_.living()) {
    const Process* parent = run_.table.LivingProcess(child.parent);
    kill(pid, parent == nullptr ? SIGTERM : StopSignalOf(*parent));
  }
  signalled_({.ns = run_.grace_began_ns, .from_outside = true});
}

bool Grace::GoOnToNextKill() {
  if (run_.table.living() == 0 || IsOver()) return false;
  std::int64_t next_ns = shm::kNeverNs;
  for (const Process& process : run_.table.processes()) {
    if (!process.dead && !process.killed) next_ns = std::min(next_ns, KillTimeOf(process));
  }
  if (next_ns == shm::kNeverNs) return false;
  run_.end_ns = next_ns;
  run_.root.EndAt(next_ns);
  return true;
}

void Grace::LimitRealTime() {
  std::int64_t longest_ns = 0;
  for (const Process& process : run_.table.processes()) {
    if (!process.dead) longest_ns = std::max(longest_ns, GraceOf(process));
  }
  double speed = 0;
  for (const Robot& robot : run_.robots) {
    speed += robot.speed * static_cast<double>(robot.cpus.size());
  }
  const double computing_ns = kMostRealFactor * speed * static_cast<double>(longest_ns);
  std::int64_t limit_ns = kLeastRealNs + static_cast<std::int64_t>(std::min(computing_ns, 1e18));
  if (run_.stop.asked()) limit_ns = std::min(limit_ns, kMostRealIfAskedNs);
  timer_.Reset(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK));
  itimerspec when{};
  when.it_value = shm::ToTimespec(limit_ns);
  timerfd_settime(timer_.get(), 0, &when, nullptr);
  reactor_.Add(timer_.get(), EPOLLIN, {Tag::kGraceRanOut});
}

void Grace::RanOut() {
  timer_.Reset();
  ran_out_ = true;
}

std::int64_t Grace::KillTimeOf(const Process& process) const {
  return shm::AddSaturated(run_.grace_began_ns, GraceOf(process));
}

void Grace::KillOverdue() {
  if (run_.table.living() == 0 || IsOver()) return;
  run_.latest_ns = run_.end_ns;
  for (Process& process : run_.table.processes()) {
    if (process.dead || process.killed || KillTimeOf(process) > run_.end_ns) continue;
    WarnOfKill(process, "its stop_grace");
    process.killed = true;
    kill(process.pid, SIGKILL);
  }
  signalled_({run_.end_ns});
}

// If there was no time for their graces: all that is left is killed.
void Grace::WarnOfThoseLeft() {
  if (!ran_out_) return;
  for (const Process& process : run_.table.processes()) {
    WarnOfKill(process, "the limit of real time for that");
  }
}

void Grace::WarnOfKill(const Process& process, const std::string& within) {
  if (process.dead || process.killed || !process.is_client || GraceOf(process) == 0) return;
  run_.Warn(fmt::format(
      "{} was killed: after SIG{} it did not end within {} ({:.3f} s), and what it had "
      "not written is lost",
      process.name, sigabbrev_np(StopSignalOf(process)), within, Seconds(GraceOf(process))));
}

}  // namespace tcs
