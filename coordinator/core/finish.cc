// The orderly end of a run, and what it reports.
#include <fmt/format.h>

#include <algorithm>

#include "coordinator/channel/udp_socket.h"
#include "coordinator/core/engine.h"
#include "coordinator/dds/topics_table.h"
#include "coordinator/os/descendants.h"
#include "coordinator/os/host.h"

namespace tcs {

// Whoever is left now is killed. None may keep the processor meanwhile, nor this process, which
// waits in the kernel for the last steps of their threads.
void Engine::Shutdown() {
  header_->shutdown.store(1);
  for (const Task& task : table_.tasks()) {
    if (task.state != TaskState::kDead) LeaveRealTime(task.tid);
  }
  LeaveRealTime(0);
  // Everything that descends from this process and lost its parent is ours to end and to reap, too.
  KillDescendants();
}

// Of those that were never started, the ones that waited for another client.
void Engine::WarnOfNeverStarted() {
  if (!report_.error.empty() || stop_.asked()) return;
  for (const Launches::Launch& launch : launches_.all()) {
    if (launch.process != nullptr || launch.start_ns != shm::kNeverNs) continue;
    Warn(fmt::format("{} was never started: it is to start after {}, which has not ended",
                     launch.spec->name, launch.spec->after));
  }
}

ClientReport Engine::ReportOf(const Launches::Launch& launch) {
  ClientReport client;
  client.name = launch.spec->name;
  if (launch.process == nullptr) return client;
  const Process& process = *launch.process;
  client.started_at_ns = process.started_at_ns;
  client.usage = usage_.UsageOfAll(process);
  client.ended_at_ns = process.ended_at_ns;
  client.wait_status = process.wait_status;
  return client;
}

void Engine::Report(RunReport* report) {
  report->virtual_ns = reached_end_ ? end_ns_ : FurthestNs();
  dds_.records().WarnOfDrops();
  WarnOfNeverStarted();
  WarnOfEndsThatDidNotMeet();
  report->drift_ns = run_.DriftNs();
  report->dynamics_ns = world_.host_ns();
  report->samples = world_.samples();
  report->commands = world_.commands();
  report->interrupted = stop_.asked();
  report->stop_signal = stop_.signal();
  for (const Launches::Launch& launch : launches_.all())
    report->clients.push_back(ReportOf(launch));
  for (const Robot& robot : robots_) {
    for (const Task* task : robot.tasks) {
      if (task->slot < 0) continue;
      report->staleness_ns = std::max(report->staleness_ns, SlotCheck::StalenessOf(*task));
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
  if (!report_.error.empty() ||
      std::any_of(table_.processes().begin(), table_.processes().end(), failed))
    return;
  for (const std::string& warning : dds::MismatchWarnings(dds_.records().topics().reports()))
    Warn(warning);
  if (!world_.present()) return;
  for (const std::string& warning : command_input_.Complaints(scenario_)) Warn(warning);
  // Whoever has ended may have listened before.
  const auto gone = [&](const Process& process) { return process.is_client && ended(process); };
  if (std::any_of(table_.processes().begin(), table_.processes().end(), gone)) return;
  for (const SensorChannelSpec& spec : scenario_.sensors) {
    if (IsListenedTo(spec.to)) continue;
    Warn(fmt::format(
        "channel {}: nobody listens on {}:{}, so that its samples are lost; let a client "
        "bind that port",
        spec.name, spec.to.host, spec.to.port));
  }
}

}  // namespace tcs
