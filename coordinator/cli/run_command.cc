#include "coordinator/cli/run_command.h"

#include <filesystem>
#include <system_error>

#include "coordinator/cli/duration_option.h"
#include "coordinator/cli/exit_status.h"
#include "coordinator/cli/live_line.h"
#include "coordinator/cli/summary.h"
#include "coordinator/scenario/load.h"

namespace tcs {

namespace {

std::string MakeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error && std::filesystem::is_directory(path)) return {};
  return "the folder '" + path +
         "' cannot be made: " + (error ? error.message() : "a file has that name") +
         "; choose another one with --out";
}

}  // namespace

int RunCommand(const RunArguments& arguments, RunOptions options) {
  ScenarioOverrides overrides;
  overrides.set = arguments.set;
  overrides.seed = arguments.seed;
  for (const std::string& error :
       {TakeDuration("duration", arguments.duration, &overrides.duration),
        TakeDuration("drift", arguments.drift, &overrides.drift)}) {
    if (!error.empty()) return Fail(error);
  }
  auto loaded = LoadScenario(arguments.scenario, overrides);
  if (const auto* error = std::get_if<LoadError>(&loaded)) return Fail(error->message);
  const Scenario& scenario = std::get<Scenario>(loaded);
  if (const std::string error = MakeFolder(arguments.out); !error.empty()) return Fail(error);
  options.output_directory = std::filesystem::absolute(arguments.out);

  LiveLine line(scenario.duration.ns());
  if (LiveLine::HasTerminal()) {
    options.on_progress = [&line](const RunProgress& progress) { line.Show(progress); };
  }
  const RunReport report = RunScenario(scenario, options);
  line.Clear();
  if (!report.error.empty()) return Fail(report.error);
  PrintSummary(scenario, report, arguments.out);
  if (const std::string error =
          WriteSummary(scenario, options, report, arguments.out + "/summary.json");
      !error.empty()) {
    return Fail(error);
  }
  if (report.interrupted) return kInterrupted;
  return HasFailedClient(report) ? kClientFailed : kSucceeded;
}

}  // namespace tcs
