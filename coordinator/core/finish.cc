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
    if (process.pidfd < 0) continue;
    syscall(SYS_pidfd_send_signal, process.pidfd, SIGTERM, nullptr, 0);
    ends.push_back({process.pidfd, POLLIN, 0});
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
  report->virtual_ns = world_.present() ? world_.progress_ns() : 0;
  WarnOfDrops();
  WarnOfEndsThatDidNotMeet();
  for (const VirtualCpu& cpu : cpus_) {
    report->virtual_ns = std::max(report->virtual_ns, cpu.progress_ns);
  }
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
    client.charged_ns = process.ended_cpu_ns;
    client.host_cpu_ns = process.ended_host_ns;
    client.stolen_ns = process.ended_stolen_ns;
    client.activations = process.ended_activations;
    client.overruns = process.overruns;
    client.ended_at_ns = process.ended_at_ns;
    client.wait_status = process.wait_status;
    for (Task* task : process.robot->tasks) {
      if (task->process != &process || task->slot < 0) continue;
      client.charged_ns += task->charged_ns;
      client.host_cpu_ns += HostCpuOf(*task);
      client.stolen_ns += StolenOf(*task);
      client.activations += task->activations;
    }
    report->clients.push_back(client);
  }
  for (const Robot& robot : robots_) {
    for (const Task* task : robot.tasks) {
      if (task->slot < 0) continue;
      report->staleness_ns = std::max(report->staleness_ns, StalenessOf(*task));
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

// What the thread's own CPU clock says that it has used since it was first charged; 0 where it can
// no longer be asked.
std::int64_t Engine::HostCpuOf(Task& task) {
  if (task.host_origin_ns < 0) return 0;
  const std::int64_t now = HostClockOf(task);
  return now < 0 ? 0 : now - task.host_origin_ns;
}

}  // namespace tcs
