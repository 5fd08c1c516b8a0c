// The orderly end of a run, and what it reports.
#include <linux/futex.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

#include "coordinator/core/engine.h"
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
  // Everything that descends from this process and lost its parent is ours to end, too.
  KillDescendants();
}

void Engine::Report(RunReport* report) {
  report->virtual_ns = world_.present() ? world_.progress_ns() : 0;
  for (const VirtualCpu& cpu : cpus_) {
    report->virtual_ns = std::max(report->virtual_ns, cpu.progress_ns);
  }
  report->drift_ns = std::max(root_.drift_ns(), most_frozen_ns_);
  report->dynamics_ns = world_.host_ns();
  report->samples = world_.samples();
  report->commands = world_.commands();
  report->client_ns = client_host_ns_;
  report->interrupted = stop_requested_;
  for (Task& task : tasks_) {
    if (task.slot < 0) continue;
    // A slot that has passed on to another thread no longer speaks of this one.
    const bool own = by_slot_[static_cast<std::size_t>(task.slot)] == &task;
    if (own) {
      report->staleness_ns = std::max(report->staleness_ns, Slot(task).clock.staleness_ns.load());
    }
    if (!task.process->is_client) continue;
    ClientReport client;
    client.name = task.process->name;
    client.charged_ns = task.charged_ns;
    if (own) client.stolen_ns = Slot(task).clock.stolen_ns.load();
    client.activations = task.activations;
    client.overruns = task.process->overruns;
    if (task.state != TaskState::kDead && task.host_origin_ns >= 0) {
      const std::int64_t now = ThreadCpuClockNs(task.tid, task.process->threads == 1);
      if (now >= 0) client.host_cpu_ns = now - task.host_origin_ns;
    }
    client.ended_at_ns = task.process->ended_at_ns;
    client.wait_status = task.process->wait_status;
    report->clients.push_back(client);
  }
}

}  // namespace tcs
