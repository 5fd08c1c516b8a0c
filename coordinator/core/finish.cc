// The orderly end of a run, and what it reports.
#include <fmt/format.h>
#include <linux/futex.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

#include "coordinator/channel/udp_socket.h"
#include "coordinator/core/engine.h"
#include "coordinator/dds/topics_table.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"

namespace tcs {

namespace {

constexpr int kGraceMs = 300;  // between SIGTERM and SIGKILL

}  // namespace

// From here on the shim lets every call through, in real time and at ordinary priority, so that a
// client's own SIGTERM handler can put its things in order.
void Engine::Shutdown() {
  header_->shutdown.store(1);
  std::vector<pollfd> ends;
  for (Task& task : tasks_) {
    if (task.state == TaskState::kDead) continue;
    LeaveRealTime(task.tid);
    if (task.slot >= 0) {
      std::atomic<std::uint32_t>& gate = Slot(task).gate;
      gate.store(shm::kGateOpen);
      syscall(SYS_futex, &gate, FUTEX_WAKE, 1, nullptr, nullptr, 0);
    }
  }
  for (Process& process : processes_) {
    if (process.dead) continue;
    kill(process.pid, SIGTERM);
    if (process.pidfd >= 0) ends.push_back({process.pidfd, POLLIN, 0});
  }
  const std::int64_t until = HostClockNs(CLOCK_MONOTONIC) + std::int64_t{kGraceMs} * 1'000'000;
  // What clients do meanwhile the kernel does for them.
  running_ = nullptr;
  ReleaseTrapped();
  ends.push_back({epoll_, POLLIN, 0});
  while (ends.size() > 1 && HostClockNs(CLOCK_MONOTONIC) < until) {
    poll(ends.data(), ends.size(), kGraceMs / 10);
    PollEvents(0);
    ReleaseTrapped();
    std::erase_if(ends, [this](const pollfd& end) { return end.fd != epoll_ && end.revents != 0; });
  }
  // Everything that descends from this process and lost its parent is ours to end and to reap, too:
  // not at a real-time priority, which would keep the last steps of their threads from being made.
  LeaveRealTime(0);
  KillDescendants();
}

void Engine::Report(RunReport* report) {
  report->virtual_ns = reached_end_ ? end_ns_ : FurthestNs();
  WarnOfDrops();
  WarnOfEndsThatDidNotMeet();
  report->drift_ns = std::max(root_.drift_ns(), most_frozen_ns_);
  report->dynamics_ns = world_.host_ns();
  report->samples = world_.samples();
  report->commands = world_.commands();
  report->client_ns = client_host_ns_;
  report->interrupted = stop_requested_;
  for (const Process& process : processes_) {
    if (!process.is_client) continue;
    ClientReport client;
    client.name = process.name;
    client.usage = UsageOfAll(process);
    client.ended_at_ns = process.ended_at_ns;
    client.wait_status = process.wait_status;
    report->clients.push_back(client);
  }
  for (const Robot& robot : robots_) {
    for (const Task* task : robot.tasks) {
      if (task->slot < 0) continue;
      report->staleness_ns = std::max(report->staleness_ns, Slot(*task).clock.staleness_ns.load());
    }
  }
}

// A robot that was out of reach of its programs, or they of it, has done nothing of what it was run
// for, and neither status nor summary would say so. Who failed has said why.
void Engine::WarnOfEndsThatDidNotMeet() {
  const auto ended = [](const Process& process) { return process.ended_at_ns >= 0; };
  const auto failed = [&](const Process& process) {
    return process.is_client && ended(process) && process.wait_status != 0;
  };
  if (!report_.error.empty() || std::any_of(processes_.begin(), processes_.end(), failed)) return;
  for (const std::string& warning : dds::MismatchWarnings(topic_log_.reports())) Warn(warning);
  if (!world_.present()) return;
  for (const std::string& warning : command_input_.Complaints(scenario_)) Warn(warning);
  // Whoever has ended may have listened before.
  const auto gone = [&](const Process& process) { return process.is_client && ended(process); };
  if (std::any_of(processes_.begin(), processes_.end(), gone)) return;
  for (const SensorChannelSpec& spec : scenario_.sensors) {
    if (IsListenedTo(spec.to)) continue;
    Warn(fmt::format(
        "channel {}: nobody listens on {}:{}, so that its samples are lost; let a client "
        "bind that port",
        spec.name, spec.to.host, spec.to.port));
  }
}

}  // namespace tcs
