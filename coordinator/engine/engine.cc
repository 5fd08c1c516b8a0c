// A run from its first moment to its report.
#include "coordinator/engine/engine.h"

#include <optional>
#include <utility>

#include "coordinator/gateway/gateway_robot.h"
#include "coordinator/os/open_file_limit.h"
#include "coordinator/os/own_computer.h"
#include "coordinator/port/clocks.h"

namespace tcs {

RunReport Engine::Run() {
  RunState& run = all_.run;
  all_.setup.Connect();
  for (const std::string& warning : run.scenario.warnings) run.Warn(warning);
  run.report.error = all_.setup.Prepare();
  if (run.report.error.empty()) {
    all_.setup.MakeRobots();
    run.report.error = all_.launches.Begin();
  }
  all_.clock.Start();
  all_.records.StartAt(all_.clock);
  try {
    // While only the world goes on, no other part looks for these signals.
    constexpr int kStepsBetweenLooksAtSignals = 64;
    for (int step = 1; run.report.error.empty() && !run.stop.asked(); ++step) {
      if (!all_.loop.Step()) break;
      if (step % kStepsBetweenLooksAtSignals == 0 && all_.end_requests.IsPending())
        all_.end_requests.Take(run);
    }
    if (!all_.loop.reached_end() && run.report.error.empty())
      all_.world.LetLastCommandsAct(all_.world_leaf.FurthestOfRun());
  } catch (const DynamicsInterrupted&) {
    all_.end_requests.Take(run);
  } catch (const DynamicsError& error) {
    run.report.error = error.what();
  }
  all_.state_link.Does(Doing::kWrites, HostTsc());
  all_.reporter.Conclude(all_.loop.reached_end() ? run.end : all_.world_leaf.FurthestOfRun());
  // The records are closed first, because what clients do at their end is no part of the run.
  const std::string& folder = run.options.output_directory;
  for (const std::string& error :
       {all_.records.Close(), all_.datagram_log.Close(), all_.dds.records().Close(),
        folder.empty() ? "" : all_.network.WriteCounts(folder)}) {
    if (run.report.error.empty()) run.report.error = error;
  }
  RunReport report = run.report;
  if (run.header != nullptr) {
    all_.run_end.EndClients();
    all_.run_end.Shutdown();
  }
  // Clients are also measured by what they print at their end.
  const std::string error = all_.records.CloseMetrics(RobotTime(report.virtual_ns));
  if (report.error.empty()) report.error = error;
  report.metrics = all_.records.Metrics();
  report.kept = all_.records.Expected();
  report.warnings = run.report.warnings;
  return report;
}

RunReport RunScenario(const Scenario& scenario, const RunOptions& options) {
  RaiseOpenFileLimit();
  if (scenario.network) {
    if (const std::optional<NoComputer> why_not = GetReadyForComputers()) {
      RunReport refused;
      refused.error = why_not->Sentence();
      return refused;
    }
  }
  Scenario whole = scenario;
  if (auto gateway = GatewayRobot(whole, options.preload_library)) {
    whole.robots.push_back(*std::move(gateway));
  }
  return Engine(whole, options).Run();
}

}  // namespace tcs
