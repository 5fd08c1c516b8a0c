#include "coordinator/engine/run_reporter.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/answers/verdict.h"
#include "coordinator/dds/topics_table.h"
#include "coordinator/engine/deadlocks.h"
#include "coordinator/engine/failures.h"
#include "coordinator/processes/slot_check.h"
#include "coordinator/text/spoken.h"

namespace tcs {

std::int64_t RunReporter::CoordinatingNs() const {
  return from_.clock.CoordinatorNs() - run_.report.awaited_ns -
         (from_.world.present() ? from_.world.host_ns() : 0);
}

RunProgress RunReporter::Now() const {
  const World& world = from_.world;
  RunProgress progress;
  progress.virtual_ns = (world.present() ? world.progress() : run_.root.Least()).ns();
  progress.real_ns = from_.clock.RealNs();
  progress.drift_ns = run_.Drift().ns();
  progress.client_ns = run_.report.client_ns;
  progress.dynamics_ns = world.present() ? world.host_ns() : 0;
  progress.coordinating_ns = CoordinatingNs();
  progress.pace = from_.pacing.Report();
  for (const Process& process : run_.table.processes()) {
    if (!process.is_client || process.robot->is_ours) continue;
    progress.clients.push_back({process.name, from_.usage.ChargedToAllOf(process).ns()});
  }
  return progress;
}

ClientReport RunReporter::ReportOf(const Launches::Launch& launch) const {
  ClientReport client;
  client.name = launch.spec->name;
  if (launch.process == nullptr) return client;
  const Process& process = *launch.process;
  client.started_at_ns = process.started_at.ns();
  client.usage = from_.usage.UsageOfAll(process);
  client.outside = process.outside;
  client.ended_at_ns = process.ended_at.has_value() ? process.ended_at->ns() : -1;
  client.wait_status = process.wait_status;
  return client;
}

void RunReporter::Conclude(VirtualTime end) {
  RunReport& report = run_.report;
  report.real_ns = from_.clock.RealNs();
  report.coordinating_ns = CoordinatingNs();
  report.virtual_ns = end.ns();
  report.pace = from_.pacing.Report();
  from_.dds_records.WarnOfDrops();
  WarnOfNeverStarted();
  WarnOfEndsThatDidNotMeet();
  report.drift_ns = run_.Drift().ns();
  report.dynamics_ns = from_.world.host_ns();
  report.samples = from_.world.samples();
  report.commands = from_.world.commands();
  report.interrupted = run_.stop.asked();
  report.stop_signal = run_.stop.signal();
  for (const Launches::Launch& launch : from_.launches.all()) {
    if (!launch.robot->is_ours) report.clients.push_back(ReportOf(launch));
  }
  if (from_.answers.is_open()) Answer(end);
  for (const Robot& robot : run_.robots) {
    for (const Task* task : robot.tasks) {
      if (task->slot < 0) continue;
      report.staleness_ns = std::max(report.staleness_ns, SlotCheck::StalenessOf(*task));
    }
  }
}

// How well clients kept up, and what of it mattered.
void RunReporter::Answer(VirtualTime end) {
  for (const Robot& robot : run_.robots) {
    for (const Task* task : robot.tasks) {
      if (task->state != TaskState::kWaiting) from_.activations.IsCutOff(*task, end);
    }
  }
  auto inputs = from_.datagrams.Conclude(end);
  if (const SampleFeed* samples = from_.dds_records.samples()) {
    for (const auto& [client, of_topics] : samples->Conclude())
      inputs[client].insert(inputs[client].end(), of_topics.begin(), of_topics.end());
  }
  const std::vector<ClientFigures> figures = from_.answers.book().Conclude(end.ns());
  std::vector<ClientOutcome> outcomes;
  for (const Launches::Launch& launch : from_.launches.all()) {
    if (launch.robot->is_ours) continue;
    const auto who = from_.answers.WhoIs(*launch.spec);
    ClientReport& client = run_.report.clients[outcomes.size()];
    ClientOutcome& outcome = outcomes.emplace_back();
    outcome.name = launch.spec->name;
    const RobotSpec& robot = run_.scenario.robots[launch.robot->number - 1];
    if (robot.scheduler == SchedulerPolicy::kFixedPriority)
      outcome.priority = launch.spec->priority;
    if (!who.has_value()) continue;
    client.figures = figures[static_cast<std::size_t>(who->client)];
    if (const auto found = inputs.find(who->client); found != inputs.end())
      client.figures.inputs = found->second;
    outcome.figures = client.figures;
  }
  run_.report.chains = from_.answers.chains().Conclude();
  std::vector<std::string>& verdict = run_.report.verdict;
  verdict = FailuresIn(run_.report, run_.scenario.duration.ns(), run_.options.output_directory);
  const std::vector<std::string> deadlocks = DeadlocksIn(run_, from_.futexes);
  verdict.insert(verdict.end(), deadlocks.begin(), deadlocks.end());
  const std::vector<std::string> late = VerdictOn(outcomes, run_.report.chains, end.ns());
  verdict.insert(verdict.end(), late.begin(), late.end());
  const std::vector<std::string> unheard = from_.datagrams.WhatNobodyHeard();
  verdict.insert(verdict.end(), unheard.begin(), unheard.end());
  if (run_.scenario.drift_bound > end - VirtualTime()) {
    verdict.push_back(
        fmt::format("the drift bound, {}, is longer than the run: nothing keeps programs and world "
                    "at one time",
                    Spoken(run_.scenario.drift_bound.ns())));
  }
}

// Warns of the clients that were never started because they waited for another client.
void RunReporter::WarnOfNeverStarted() {
  if (!run_.report.error.empty() || run_.stop.asked()) return;
  for (const Launches::Launch& launch : from_.launches.all()) {
    if (launch.process != nullptr || !launch.start.IsNever()) continue;
    run_.Warn(fmt::format("{} was never started, because it starts after {}, which has not ended",
                          launch.spec->name, launch.spec->after));
  }
}

// A robot that was out of reach of its programs, or whose programs were out of its reach, has done
// nothing of what it was run for, and neither status nor summary would say so. A client that failed
// has said why.
void RunReporter::WarnOfEndsThatDidNotMeet() {
  const auto ended = [](const Process& process) { return process.ended_at.has_value(); };
  const auto failed = [&](const Process& process) {
    return process.is_client && ended(process) && process.wait_status != 0;
  };
  if (!run_.report.error.empty() ||
      std::any_of(run_.table.processes().begin(), run_.table.processes().end(), failed))
    return;
  for (const std::string& warning : dds::MismatchWarnings(from_.dds_records.topics().reports()))
    run_.Warn(warning);
  if (!from_.world.present()) return;
  for (const std::string& warning : from_.world.CommandComplaints()) run_.Warn(warning);
  for (const std::string& warning : from_.world.LossesOfSensors()) run_.Warn(warning);
  // A client that has ended may have listened before.
  const auto gone = [&](const Process& process) { return process.is_client && ended(process); };
  if (std::any_of(run_.table.processes().begin(), run_.table.processes().end(), gone)) return;
  for (const std::string& warning : from_.world.UnheardSensors()) run_.Warn(warning);
}

}  // namespace tcs
