// The end of a run for the clients that still live. Each gets a signal, and a grace of virtual time
// in which it may write what it has and exit; then it is killed. The results stand already: the
// world has stopped, and nothing of this is recorded.
#include <fmt/format.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

// What real time the grace may take: twice what all virtual CPUs take that compute all through it,
// and some to begin with. If somebody waits for the end, no more than the guardian allows for.
constexpr std::int64_t kLeastRealNs = 2'000'000'000, kMostRealIfAskedNs = 6'000'000'000;
constexpr double kMostRealFactor = 2.0;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

// What a program alone is asked with is what its user has sent.
int Engine::StopSignalOf(const Process& process) const {
  if (options_.output_directory.empty() && stop_.asked()) return stop_.signal();
  return process.client == nullptr ? SIGTERM : process.client->spec->stop_signal;
}

std::int64_t Engine::GraceOf(const Process& process) {
  if (process.client == nullptr) return ClientSpec{}.stop_grace.ns();
  return process.client->spec->stop_signal == SIGKILL ? 0 : process.client->spec->stop_grace.ns();
}

void Engine::EndClients() {
  BeginGrace();
  while (table_.living() > 0 && !IsGraceOver()) {
    std::int64_t next_ns = shm::kNeverNs;
    for (const Process& process : table_.processes()) {
      if (!process.dead && !process.killed) next_ns = std::min(next_ns, KillTimeOf(process));
    }
    if (next_ns == shm::kNeverNs) break;
    end_ns_ = next_ns;
    root_.EndAt(end_ns_);
    idle_at_ns_ = -1;
    while (!IsGraceOver() && Step()) {
    }
    if (table_.living() > 0 && !IsGraceOver()) KillOverdue();
  }
  if (grace_ran_out_) {
    for (Process& process : table_.processes())
      WarnOfKill(process, "the real time that there is for that");
  }
}

void Engine::BeginGrace() {
  grace_began_ns_ = report_.virtual_ns;
  if (turn_.lasts()) Settle(*turn_.task());  // the dynamics have failed beside it
  turn_.End();
  root_.EndDynamics();
  dds_.records().Stop();
  for (const int fd : world_.command_fds()) reactor_.Remove(fd);
  for (VirtualCpu& cpu : cpus_) {
    if (reached_end_) cpu.ComeTo(std::max(cpu.progress_ns, grace_began_ns_));
  }
  launches_.Stop();
  LimitRealTime();
  latest_ns_ = grace_began_ns_;
  for (const Process& process : table_.processes()) {
    if (process.dead) continue;
    kill(process.pid, StopSignalOf(process));
    if (ThreadState(process.pid) == 'T') kill(process.pid, SIGCONT);
  }
  for (const auto& [pid, child] : unknown_children_.living()) {
    const Process* parent = LivingProcess(child.parent);
    kill(pid, parent == nullptr ? SIGTERM : StopSignalOf(*parent));
  }
  WakeSignalled(0, {.ns = grace_began_ns_, .from_outside = true});
}

void Engine::LimitRealTime() {
  std::int64_t longest_ns = 0;
  for (const Process& process : table_.processes()) {
    if (!process.dead) longest_ns = std::max(longest_ns, GraceOf(process));
  }
  double speed = 0;
  for (const Robot& robot : robots_) speed += robot.speed * static_cast<double>(robot.cpus.size());
  const double computing_ns = kMostRealFactor * speed * static_cast<double>(longest_ns);
  std::int64_t limit_ns = kLeastRealNs + static_cast<std::int64_t>(std::min(computing_ns, 1e18));
  if (stop_.asked()) limit_ns = std::min(limit_ns, kMostRealIfAskedNs);
  grace_timer_.Reset(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK));
  itimerspec when{};
  when.it_value = shm::ToTimespec(limit_ns);
  timerfd_settime(grace_timer_.get(), 0, &when, nullptr);
  reactor_.Add(grace_timer_.get(), EPOLLIN, {Tag::kGraceRanOut});
}

std::int64_t Engine::KillTimeOf(const Process& process) const {
  return shm::AddSaturated(grace_began_ns_, GraceOf(process));
}

void Engine::KillOverdue() {
  latest_ns_ = end_ns_;
  for (Process& process : table_.processes()) {
    if (process.dead || process.killed || KillTimeOf(process) > end_ns_) continue;
    WarnOfKill(process, "its stop_grace");
    process.killed = true;
    kill(process.pid, SIGKILL);
  }
  WakeSignalled(0, {end_ns_});
}

void Engine::WarnOfKill(const Process& process, const std::string& within) {
  if (process.dead || process.killed || !process.is_client || GraceOf(process) == 0) return;
  Warn(fmt::format(
      "{} was killed: after SIG{} it did not end within {} ({:.3f} s), and what it had "
      "not written is lost",
      process.name, sigabbrev_np(StopSignalOf(process)), within, Seconds(GraceOf(process))));
}

}  // namespace tcs
