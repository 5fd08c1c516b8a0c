#include "coordinator/cli/trials_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/basics/version.h"
#include "coordinator/cli/duration_option.h"
#include "coordinator/cli/expected.h"
#include "coordinator/cli/preload_library.h"
#include "coordinator/cli/print.h"
#include "coordinator/cli/terminal_line.h"
#include "coordinator/cli/trials_expected.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/cpu_places.h"
#include "coordinator/os/files.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/own_network.h"
#include "coordinator/os/real_time_facts.h"
#include "coordinator/port/pidfds.h"
#include "coordinator/scenario/load.h"
#include "coordinator/trials/local_launcher.h"
#include "coordinator/trials/record.h"
#include "coordinator/trials/result_folder.h"
#include "coordinator/trials/results.h"
#include "coordinator/trials/slurm/array_jobs.h"
#include "coordinator/trials/slurm/slurm_launcher.h"

namespace tcs {

namespace {

namespace fs = std::filesystem;

// A run may take ten seconds to stop.
constexpr unsigned kStopWithinS = 15;
// Larger files that a command names are data; to hash them would take a while.
constexpr std::uintmax_t kLargestProgram = 64 << 20;

// The scenario as each group of trials runs it. The sentence, if a group cannot be run.
std::string LoadGroups(const TrialsArguments& arguments, const TrialsPlan& plan,
                       std::vector<Scenario>* scenarios) {
  ScenarioOverrides overrides;
  for (const std::string& error :
       {TakeDuration("duration", arguments.options.duration, &overrides.duration),
        TakeDuration("drift", arguments.options.drift, &overrides.drift)}) {
    if (!error.empty()) return error;
  }
  for (std::size_t group = 0; group < GroupCount(plan); ++group) {
    overrides.set = SettingsOf(plan, group);
    overrides.result_directory = AbsolutePathOf(arguments.out);
    auto loaded = LoadScenario(arguments.scenario, overrides);
    if (const auto* error = std::get_if<LoadError>(&loaded)) return error->message;
    scenarios->push_back(std::move(std::get<Scenario>(loaded)));
  }
  return {};
}

// Adds the values of the overlays' files to the options, so that each trial is told, and the
// folder's record says, what the files say now.
std::string AddOverlays(const TrialsArguments& arguments, TrialOptions* options) {
  std::vector<std::string> set;
  for (const std::string& path : arguments.overlays) {
    const auto loaded = LoadOverlay(path);
    if (const auto* error = std::get_if<LoadError>(&loaded)) return error->message;
    const auto& texts = std::get<std::vector<std::string>>(loaded);
    set.insert(set.end(), texts.begin(), texts.end());
  }
  options->set.insert(options->set.begin(), set.begin(), set.end());
  return {};
}

std::string MakePlan(const TrialsArguments& arguments, TrialsPlan* plan,
                     std::vector<Scenario>* scenarios) {
  plan->options = arguments.options;
  if (std::string error = AddOverlays(arguments, &plan->options); !error.empty()) return error;
  plan->trials = arguments.trials;
  for (const std::string& text : arguments.vary) {
    if (std::string error = ParseVary(text, &plan->vary.emplace_back()); !error.empty()) {
      return error;
    }
  }
  if (std::string error = WhatHidesValues(*plan); !error.empty()) return error;
  if (std::string error = LoadGroups(arguments, *plan, scenarios); !error.empty()) return error;
  const Scenario& scenario = scenarios->front();
  plan->scenario = fs::absolute(arguments.scenario).lexically_normal();
  plan->name = arguments.name.empty() ? scenario.name : arguments.name;
  plan->first_seed = arguments.first_seed.value_or(scenario.seed);
  const auto others = static_cast<std::uint64_t>(plan->trials - 1);
  if (plan->first_seed > std::numeric_limits<std::uint64_t>::max() - others) {
    return fmt::format("--first-seed: {} is too large for {} seeds; begin with a smaller one",
                       plan->first_seed, plan->trials);
  }
  return {};
}

// The programs of the clients, and the scripts that they are told to run.
std::map<std::string, std::string> HashPrograms(const Scenario& scenario) {
  std::map<std::string, std::string> hashes;
  for (const RobotSpec& robot : scenario.robots) {
    for (const ClientSpec& client : robot.clients) {
      for (const std::string& word : client.command) {
        const bool is_copied = !client.copied_folder.empty();
        const fs::path path =
            fs::path(is_copied ? client.copied_folder : client.working_directory) / word;
        std::error_code error;
        if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > kLargestProgram) {
          continue;
        }
        hashes[path.lexically_normal()] = HashOfFile(path);
      }
    }
  }
  return hashes;
}

// An address that is not this machine's loopback does not exist in a network of a trial's own.
bool NeedsHostNetwork(const Scenario& scenario) {
  const auto is_elsewhere = [](const auto& end) {
    const auto* endpoint = std::get_if<UdpEndpoint>(&end);
    return endpoint != nullptr && endpoint->host.rfind("127.", 0) != 0 &&
           endpoint->host != "0.0.0.0";
  };
  return std::any_of(scenario.sensors.begin(), scenario.sensors.end(),
                     [&](const SensorChannelSpec& channel) { return is_elsewhere(channel.to); }) ||
         std::any_of(scenario.commands.begin(), scenario.commands.end(),
                     [&](const CommandChannelSpec& channel) { return is_elsewhere(channel.from); });
}

LocalOptions ShareMachine(const TrialsArguments& arguments, const Scenario& scenario) {
  LocalOptions options;
  const std::vector<CpuPlace> cpus = CpuPlaces();
  const auto cpu_count = static_cast<int>(cpus.size());
  options.whole_cores = arguments.options.accounting == "measured";
  options.at_once = arguments.jobs > 0 ? arguments.jobs : RunsAtOnce(cpus, options.whole_cores);
  if (options.at_once > cpu_count) {
    Say(fmt::format("--jobs {}: each run needs a processor of its own, so {} run at a time",
                    arguments.jobs, cpu_count));
    options.at_once = cpu_count;
  }
  std::string why_not;
  if (arguments.host_network) return options.at_once = 1, options;
  if (NeedsHostNetwork(scenario)) {
    why_not = "a channel's address is not on 127.0.0.1";
  } else {
    why_not = WhyNoOwnNetwork();
  }
  options.own_networks = why_not.empty();
  if (!options.own_networks) {
    Say(
        fmt::format("trials run one at a time, in this machine's network, because they cannot have "
                    "networks of their own ({})",
                    why_not));
    options.at_once = 1;
  }
  return options;
}

std::unique_ptr<Launcher> MakeLauncher(const TrialsArguments& arguments, const Scenario& scenario) {
  if (arguments.launcher == "slurm") {
    SlurmOptions options;
    options.most_jobs = arguments.jobs;
    options.whole_cores = arguments.options.accounting == "measured";
    options.in_host_network = arguments.host_network || NeedsHostNetwork(scenario);
    options.options = arguments.slurm_options;
    options.tcsim = OwnProgram();  // jobs start it on their nodes
    options.version = kVersion;
    return std::make_unique<SlurmLauncher>(std::move(options));
  }
  LocalOptions options = ShareMachine(arguments, scenario);
  options.waits_for_cpu = !arguments.no_wait;
  return std::make_unique<LocalLauncher>(options);
}

// Why the launcher cannot be used with these arguments; empty if it can.
std::string CheckLauncher(const TrialsArguments& arguments) {
  if (arguments.launcher != "slurm") {
    return arguments.slurm_options.empty()
               ? ""
               : "--slurm-option is for trials on a cluster; add --launcher slurm";
  }
  if (arguments.no_wait) {
    return "--no-wait is for trials on this machine; leave it out with --launcher slurm";
  }
  for (const std::string& option : arguments.slurm_options) {
    if (std::string why = WhyNotForSbatch(option); !why.empty()) return why;
  }
  return WhyNoSlurm();
}

// For trials that are not to wait: the sentence about who has the processors; empty if one is free,
// or none is needed for a run alone.
std::string WhoHasProcessors() {
  if (AskForRealTime().error != 0 || WhyNoDuplicates() != 0) return {};
  const auto claim = ClaimCpu(false);  // and given back at once
  const auto* taken = std::get_if<std::string>(&claim);
  return taken == nullptr ? std::string() : *taken;
}

// "seed 3", "seed 3 with drift=1ms"
std::string NameOf(const TrialsPlan& plan, const Trial& trial) {
  const std::string seed = fmt::format("seed {}", trial.seed);
  return !plan.vary.empty() ? seed + " with " + GroupLabels(plan)[trial.group] : seed;
}

// "seed 3 failed: its last words (where the log is)"
std::string Failure(const TrialsPlan& plan, const TrialEnd& end, const std::string& folder) {
  const std::string log = fmt::format("{}/{}/tcsim.log", folder, end.trial.folder);
  std::error_code error;
  return fmt::format("{} failed: {}{}", NameOf(plan, end.trial), end.why,
                     fs::exists(log, error) ? " (" + log + ")" : "");
}

// Prints what a trial came to, as the trial ends: for a log.
void PrintEnd(const TrialsPlan& plan, const TrialEnd& end, const TrialsProgress& progress,
              const std::string& folder) {
  const std::string how =
      end.outcome.has_value()
          ? fmt::format("{}: done in {:.3f} s, {:.2f} x real time", NameOf(plan, end.trial),
                        static_cast<double>(end.outcome->real_ns) * 1e-9,
                        static_cast<double>(end.outcome->virtual_ns) /
                            static_cast<double>(std::max<std::int64_t>(1, end.outcome->real_ns)))
          : Failure(plan, end, folder);
  Print("{}; {} of {}\n", how, progress.done + progress.failed, progress.total);
  std::fflush(stdout);
}

// Runs the trials that are not done yet, and says what all trials came to.
int RunPlan(const TrialsArguments& arguments, const TrialsPlan& plan,
            const std::vector<Scenario>& scenarios) {
  std::vector<TrialsGroup> groups;
  for (const std::string& label : GroupLabels(plan)) groups.push_back({label, plan.trials, {}});
  std::vector<std::int64_t> duration_ns;
  for (const Scenario& scenario : scenarios) duration_ns.push_back(scenario.duration.ns());
  const std::string& folder = arguments.out;
  std::vector<Trial> todo;
  std::vector<TrialOutcome> earlier;
  for (const Trial& trial : TrialsOf(plan)) {
    const auto outcome = ReadOutcome(folder + "/" + trial.folder, trial.seed);
    if (!outcome.has_value()) {
      todo.push_back(trial);
      continue;
    }
    earlier.push_back(*outcome);
    groups[trial.group].done.push_back(*outcome);
  }

  LauncherReport report;
  if (!todo.empty()) {
    if (arguments.no_wait) {
      if (const std::string taken = WhoHasProcessors(); !taken.empty()) return Fail(taken);
    }
    const std::unique_ptr<Launcher> launcher = MakeLauncher(arguments, scenarios.front());
    if (!earlier.empty()) {
      Print("{} of {} trials are done already\n", earlier.size(), earlier.size() + todo.size());
      std::fflush(stdout);
    }
    TerminalLine line;
    LauncherEvents events;
    if (TerminalLine::IsSeen()) {
      events.on_progress = [&line](const TrialsProgress& progress) {
        line.Show(ProgressLine(progress, TerminalLine::Columns()));
      };
      events.on_end = [&](const TrialEnd& end, const TrialsProgress&) {
        if (end.outcome.has_value()) return;
        line.Clear();
        Say(Failure(plan, end, folder));
      };
    } else {
      events.on_end = [&](const TrialEnd& end, const TrialsProgress& progress) {
        PrintEnd(plan, end, progress, folder);
      };
    }
    events.on_stopping = [&line] {
      line.Clear();
      Say("ending the running trials");
    };
    events.on_loss = [&](const TrialLoss& loss) {
      line.Clear();
      Say(fmt::format("{} was lost on node {} ({}){}", NameOf(plan, loss.trial), loss.node,
                      loss.why, loss.again ? "; it is run again" : ""));
    };
    events.on_notice = [&line](const std::string& sentence) {
      line.Clear();
      Say(sentence);
    };
    report = launcher->Run({plan, folder, todo, earlier, duration_ns}, events);
    line.Clear();
  }

  int failed = 0;
  for (const TrialEnd& end : report.ends) {
    if (end.outcome.has_value()) {
      groups[end.trial.group].done.push_back(*end.outcome);
    }
    failed += end.outcome.has_value() ? 0 : 1;
  }
  const std::string unwritten = WriteResults(folder, plan);
  if (!unwritten.empty()) Say(unwritten);
  Print("{}written to {}: trials.json, and each trial's folder as of tcsim run\n",
        TrialsTable(groups), arguments.out);
  std::fflush(stdout);
  std::vector<std::string> failures;
  for (const TrialEnd& end : report.ends) {
    if (end.outcome.has_value()) continue;
    failures.push_back(Failure(plan, end, folder));
    Say(failures.back());
  }
  if (report.interrupted) {
    return Fail(fmt::format("interrupted; {} of {} trials are done, and the same call goes on from "
                            "there",
                            earlier.size() + report.ends.size() - static_cast<std::size_t>(failed),
                            earlier.size() + todo.size()),
                InterruptedBy(report.stop_signal));
  }
  if (!report.error.empty()) return Fail(report.error);
  const JudgedTrials judged = JudgeTrials(plan, scenarios, folder, arguments.strict);
  PrintJudged(judged);
  if (!arguments.junit.empty()) {
    const std::string error = WriteJunit(arguments.junit, plan, judged, failures);
    if (!error.empty()) return Fail(error);
  }
  if (failed > 0) return kClientFailed;
  return judged.IsAsExpected() ? kSucceeded : kExpectationFailed;
}

}  // namespace

int TrialsCommand(const TrialsArguments& arguments) {
  const auto all = [&arguments] {
    TrialsPlan plan;
    std::vector<Scenario> scenarios;
    if (const std::string error = CheckLauncher(arguments); !error.empty()) return Fail(error);
    if (const std::string error = MakePlan(arguments, &plan, &scenarios); !error.empty()) {
      return Fail(error);
    }
    for (const Scenario& scenario : scenarios) {
      if (arguments.strict && !scenario.warnings.empty()) return RefuseWarnings(scenario);
    }
    ResultFolder folder;
    const TrialsRecord record{plan, HashOfFile(plan.scenario), HashPrograms(scenarios.front())};
    if (const std::string error =
            EnterResultFolder(arguments.out, arguments.restart, record, &folder);
        !error.empty()) {
      return Fail(error);
    }
    if (folder.has_trials && !folder.changed_program.empty()) {
      Say(
          fmt::format("warning: {} has changed since the first trials in '{}'; --restart runs "
                      "them all as it is now",
                      folder.changed_program, arguments.out));
    }
    if (const std::string error = CancelJobs(folder.left_jobs); !error.empty()) Say(error);
    return FlushStdout(RunPlan(arguments, plan, scenarios));
  };
  return RunGuarded(all, {.stop_within_s = kStopWithinS});
}

}  // namespace tcs
