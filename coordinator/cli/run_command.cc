#include "coordinator/cli/run_command.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "coordinator/cli/duration_option.h"
#include "coordinator/cli/exit_status.h"
#include "coordinator/cli/live_line.h"
#include "coordinator/cli/summary.h"
#include "coordinator/os/files.h"
#include "coordinator/scenario/load.h"

namespace tcs {

namespace {

// For `tcsim trials`, which made the file: the virtual time, as one number at its beginning.
void SayHowFar(int fd, const RunProgress& progress) {
  const ssize_t n = pwrite(fd, &progress.virtual_ns, sizeof progress.virtual_ns, 0);
  static_cast<void>(n);  // nobody has to know
}

}  // namespace

int RunCommand(const RunArguments& arguments, RunOptions options) {
  ScenarioOverrides overrides;
  overrides.set = arguments.set;
  overrides.seed = arguments.seed;
  overrides.result_directory = AbsolutePathOf(arguments.out);
  for (const std::string& error :
       {TakeDuration("duration", arguments.duration, &overrides.duration),
        TakeDuration("drift", arguments.drift, &overrides.drift)}) {
    if (!error.empty()) return Fail(error);
  }
  auto loaded = LoadScenario(arguments.scenario, overrides);
  if (const auto* error = std::get_if<LoadError>(&loaded)) return Fail(error->message);
  const Scenario& scenario = std::get<Scenario>(loaded);
  if (const std::string error = MakeFolder(arguments.out); !error.empty()) return Fail(error);
  const FolderLock lock(arguments.out);
  if (!lock.IsOurs()) {
    return Fail("another run writes to the folder '" + arguments.out +
                "'; wait for it, or choose another one with --out");
  }
  options.output_directory = overrides.result_directory;

  LiveLine line(scenario.duration.ns());
  const int progress_fd = arguments.progress_fd;
  if (progress_fd >= 0) {
    fcntl(progress_fd, F_SETFD, FD_CLOEXEC);
    options.on_progress = [progress_fd](const RunProgress& p) { SayHowFar(progress_fd, p); };
  } else if (TerminalLine::IsSeen()) {
    options.on_progress = [&line](const RunProgress& progress) { line.Show(progress); };
  }
  options.on_warning = [&line](const std::string& warning) {
    line.Clear();
    Say("warning: " + warning);
  };
  const RunReport report = RunScenario(scenario, options);
  line.Clear();
  if (!report.error.empty()) return Fail(report.error);
  PrintSummary(scenario, report, arguments.out);
  if (const std::string error =
          WriteSummary(scenario, options, report, arguments.out + "/summary.json");
      !error.empty()) {
    return Fail(error);
  }
  if (report.interrupted) return InterruptedBy(report.stop_signal);
  return HasFailedClient(report) ? kClientFailed : kSucceeded;
}

}  // namespace tcs
