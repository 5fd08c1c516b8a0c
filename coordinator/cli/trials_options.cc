#include "coordinator/cli/trials_options.h"

#include <CLI/CLI.hpp>
#include <limits>

namespace tcs {

const CLI::App* AddTrials(CLI::App* app, TrialsArguments* arguments) {
  constexpr int kMost = 1'000'000;
  TrialOptions& options = arguments->options;
  CLI::App* trials = app->add_subcommand(
      "trials", "run a scenario with many seeds; called again, go on where it ended");
  trials->add_option("scenario", arguments->scenario, "FILE: the YAML file (docs/SCENARIO.md)")
      ->capture_default_str();
  trials
      ->add_option("--trials", arguments->trials,
                   "the number of trials, each with a seed of its own")
      ->required()
      ->check(CLI::Range(1, kMost));
  trials->add_option("--first-seed", arguments->first_seed,
                     "the first seed (default: the scenario's)");
  trials
      ->add_option("--out", arguments->out,
                   "FOLDER: where the results of all trials go (docs/TRIALS.md)")
      ->capture_default_str();
  trials
      ->add_option("--jobs", arguments->jobs,
                   "how many trials run at once (default: one for each free processor, and as "
                   "many as Slurm has room for)")
      ->check(CLI::Range(1, kMost));
  trials
      ->add_option("--launcher", arguments->launcher,
                   "where the trials run; local: on this machine (default); slurm: as jobs of a "
                   "cluster, with the folder on a file system that its nodes share")
      ->check(CLI::IsMember({"local", "slurm"}));
  trials
      ->add_option("--slurm-option", arguments->slurm_options,
                   "OPTION: of sbatch, such as --slurm-option=--partition=short; repeatable")
      ->allow_extra_args(false);
  trials
      ->add_option("--vary", arguments->vary,
                   "KEY=V1,V2,...: run all trials for each of these values of a key of the "
                   "scenario; repeatable: each value of one key with each of the others")
      ->allow_extra_args(false);
  trials->add_option("--name", arguments->name, "the name of the trials in a report");
  trials->add_flag("--no-wait", arguments->no_wait,
                   "if other runs have all processors, fail at once and name those runs");
  trials->add_flag("--strict", arguments->strict,
                   "each warning is an error, of the scenario (exit status 2) and of a trial (3)");
  trials->add_option("--junit", arguments->junit,
                     "FILE: write what the scenario expects, and whether the trials came to that, "
                     "as JUnit XML");
  trials->add_flag("--restart", arguments->restart, "delete the trials in the folder first");
  trials->add_flag("--host-network", arguments->host_network,
                   "run one trial at a time, in this machine's network, instead of each in a "
                   "network of its own");
  trials->add_option("--duration", options.duration,
                     "TIME: how much virtual time each run lasts, such as 20s");
  trials->add_option("--drift", options.drift,
                     "TIME: how far progress may drift apart, such as 1ms");
  trials
      ->add_option("--overlay", arguments->overlays,
                   "FILE: a piece of a scenario whose values replace the scenario's")
      ->allow_extra_args(false);
  trials->add_option("--set", options.set, "KEY=VALUE: another value for a key of the scenario")
      ->allow_extra_args(false);
  trials->add_option("--sync", options.sync, "as for run")
      ->check(CLI::IsMember({"consistent", "callback"}));
  trials->add_option("--accounting", options.accounting, "as for run")
      ->check(CLI::IsMember({"measured", "fixed"}));
  return trials;
}

}  // namespace tcs
