#include "coordinator/cli/run_command.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/check_command.h"
#include "coordinator/cli/duration_option.h"
#include "coordinator/cli/earlier_run.h"
#include "coordinator/cli/expected.h"
#include "coordinator/cli/live_line.h"
#include "coordinator/cli/print.h"
#include "coordinator/cli/stop_at.h"
#include "coordinator/cli/summary.h"
#include "coordinator/cli/tools.h"
#include "coordinator/errors/nearest.h"
#include "coordinator/errors/visible.h"
#include "coordinator/os/files.h"
#include "coordinator/os/guardian.h"
#include "coordinator/scenario/leave_out_later.h"
#include "coordinator/scenario/load.h"
#include "coordinator/view/view_link.h"

namespace tcs {

namespace {

const std::vector<std::string> kNoWarnings;
constexpr std::int64_t kNoteEveryNs = 1'000'000'000;  // real time

// The report of a run that goes on, as far as it is known.
RunReport UntilNow(const RunProgress& progress) {
  RunReport report;
  report.virtual_ns = progress.virtual_ns;
  report.real_ns = progress.real_ns;
  report.drift_ns = progress.drift_ns;
  report.client_ns = progress.client_ns;
  report.dynamics_ns = progress.dynamics_ns;
  report.coordinating_ns = progress.coordinating_ns;
  for (const RunProgress::Load& load : progress.clients) {
    ClientReport client;
    client.name = load.client;
    client.usage.charged_ns = load.charged_ns;
    client.usage.host_cpu_ns = -1;
    report.clients.push_back(client);
  }
  return report;
}

// Writes the virtual time for `tcsim trials`, which made the file: one number at the file's
// beginning.
void SayHowFar(int fd, const RunProgress& progress) {
  const ssize_t n = pwrite(fd, &progress.virtual_ns, sizeof progress.virtual_ns, 0);
  static_cast<void>(n);  // no failure has to be known
}

// Only a world goes by the wall clock: without one nothing says when virtual time passes while all
// programs sleep.
std::string TakePace(const RunArguments& arguments, const Scenario& scenario, RunOptions* options) {
  const char* what = arguments.pace > 0 ? "--pace" : options->view != nullptr ? "--view" : nullptr;
  if (what != nullptr && !scenario.world.has_value()) {
    return fmt::format(
        "{} is for worlds, and the scenario {} has none: give it `dynamics`, or leave {} out", what,
        Visible(scenario.path), what);
  }
  options->pace = arguments.pace;
  options->starts_standing = arguments.pauses;
  return {};
}

// Takes which client is debugged. The sentence, if there is no such client.
std::string TakeDebugged(const std::string& name, const Scenario& scenario, const GdbSession& gdb,
                         RunOptions* options) {
  if (name.empty()) return {};
  std::vector<std::string> known;
  for (const RobotSpec& robot : scenario.robots) {
    for (const ClientSpec& client : robot.clients) known.push_back(client.name);
  }
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    return "--gdb: there is no client '" + name + "'; " + Suggest(name, known, "clients");
  }
  options->debugged = name;
  options->on_debuggee = gdb.begin;
  options->is_debugger_gone = gdb.has_ended;
  return {};
}

// A number that differs for each run on this computer, as far as chance goes.
std::uint32_t NumberOfThisRun() {
  std::uint32_t number = 0;
  if (getrandom(&number, sizeof number, 0) != sizeof number) {
    number = static_cast<std::uint32_t>(getpid());
  }
  return number;
}

}  // namespace

int RunCommand(const RunArguments& arguments, RunOptions options, const GdbSession& gdb) {
  ScenarioOverrides overrides;
  overrides.overlays = arguments.overlays;
  overrides.set = arguments.set;
  overrides.seed = arguments.seed;
  overrides.result_directory = AbsolutePathOf(arguments.out);
  overrides.run = NumberOfThisRun();
  std::optional<VirtualDuration> stop_at;
  for (const std::string& error :
       {TakeDuration("duration", arguments.duration, &overrides.duration),
        TakeDuration("stop-at", arguments.stop_at, &stop_at),
        TakeDuration("drift", arguments.drift, &overrides.drift),
        TakeDuration("patience", arguments.patience, &overrides.patience)}) {
    if (!error.empty()) return Fail(error);
  }
  auto loaded = LoadScenario(arguments.scenario, overrides);
  if (const auto* error = std::get_if<LoadError>(&loaded)) return Fail(error->message);
  Scenario& scenario = std::get<Scenario>(loaded);
  if (stop_at) {
    const std::string error = WhyNoStopAt(scenario, scenario.duration, *stop_at);
    if (!error.empty()) return Fail(error);
    scenario.duration = *stop_at;
    LeaveOutLater(&scenario);
  }
  if (arguments.check) return SaySound(scenario, arguments.strict);
  if (arguments.strict && !scenario.warnings.empty()) return RefuseWarnings(scenario);
  for (const std::string& error : {TakePace(arguments, scenario, &options),
                                   TakeDebugged(arguments.debugged, scenario, gdb, &options)}) {
    if (!error.empty()) return Fail(error);
  }
  if (const std::string error = MakeFolder(arguments.out); !error.empty()) return Fail(error);
  const FolderLock lock(arguments.out);
  if (!lock.IsOurs()) {
    return Fail("another run writes to the folder '" + arguments.out +
                "'; wait for it, or choose another one with --out");
  }
  options.output_directory = overrides.result_directory;
  std::error_code ignored;  // the snapshot of an earlier run
  std::filesystem::remove(overrides.result_directory + "/snapshot.yaml", ignored);
  if (options.view != nullptr) {
    // This comes before anybody knows where to ask for something else.
    options.view->Begin(arguments.pace, arguments.pauses);
    Say(fmt::format("watch the run at {}{}", options.view->url(),
                    arguments.pauses ? ", where it is paused until the page lets it go on" : ""));
  }

  LiveLine line(scenario.duration.ns());
  const int progress_fd = arguments.progress_fd;
  const bool is_seen = progress_fd < 0 && arguments.debugged.empty() && TerminalLine::IsSeen();
  if (progress_fd >= 0) fcntl(progress_fd, F_SETFD, FD_CLOEXEC);
  const std::string unfinished = overrides.result_directory + "/unfinished.json";
  std::int64_t next_note_ns = 0;
  options.on_progress = [&](const RunProgress& progress) {
    if (progress_fd >= 0) SayHowFar(progress_fd, progress);
    if (is_seen) line.Show(progress);
    if (progress.real_ns < next_note_ns) return;
    next_note_ns = progress.real_ns + kNoteEveryNs;
    LeaveNote(unfinished, SummaryText(scenario, options, UntilNow(progress)));
  };
  options.on_warning = [&line](const std::string& warning) {
    line.Clear();
    Say("warning: " + warning);
  };
  options.on_notice = [&line](const std::string& notice) {
    line.Clear();
    Say(notice);
  };
  options.before_writing = [&] { RemoveLogsOfEarlierRun(overrides.result_directory, scenario); };
  const RunReport report = RunScenario(scenario, options);
  line.Clear();
  if (!report.error.empty()) return Fail(report.error);
  PrintSummary(scenario, report, arguments.out);
  const std::string summary = SummaryText(scenario, options, report);
  // Half a run does not tell whether the expectations hold.
  std::vector<Judgement> judgements;
  if (!report.interrupted) judgements = JudgeRun(scenario.expectations, summary, report.kept);
  if (const std::string error = WriteWhole(arguments.out + "/summary.json",
                                           SummaryText(scenario, options, report, judgements));
      !error.empty()) {
    return Fail(error);
  }
  PrintJudgements(judgements, scenario.not_judged);
  const std::vector<std::string> refused = arguments.strict ? report.warnings : kNoWarnings;
  SayRefused(refused);
  TakeNoteBack();
  if (options.view != nullptr) options.view->Conclude(report.virtual_ns);
  if (stop_at && !report.interrupted) {
    if (const int status = WriteSnapshot(overrides.result_directory); status != kSucceeded) {
      return status;
    }
    Print("the world as it stopped: {}/snapshot.yaml\n", Visible(arguments.out));
  }
  if (report.interrupted) return InterruptedBy(report.stop_signal);
  if (!arguments.junit.empty()) {
    const std::string error = WriteWhole(
        arguments.junit, JunitText({JunitSuiteOf(scenario, report, judgements, refused)}));
    if (!error.empty()) return Fail(error);
  }
  if (HasFailedClient(report)) return kClientFailed;
  return Failed(judgements).empty() && refused.empty() ? kSucceeded : kExpectationFailed;
}

}  // namespace tcs
