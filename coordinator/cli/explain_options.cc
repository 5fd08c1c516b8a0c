#include <CLI/CLI.hpp>

#include "coordinator/cli/explain_command.h"

namespace tcs {

const CLI::App* AddExplain(CLI::App* app, ExplainArguments* arguments) {
  CLI::App* explain = app->add_subcommand(
      "explain", "why a run's clients were late: what the time of each activation went into");
  explain->add_option("folder", arguments->folder, "FOLDER: what `tcsim run` wrote")->required();
  explain->add_option("of", arguments->client,
                      "ROBOT/CLIENT: only that client; or a chain, such as 'lidar->wheels' "
                      "(default: all clients)");
  explain
      ->add_option("--worst", arguments->worst,
                   "N: so many, those that were most late, or took longest, first (default: 5)")
      ->check(CLI::PositiveNumber);
  explain->add_option("--at", arguments->at, "TIME: those that were going on then, such as 3.12s");
  explain->add_flag("--json", arguments->as_json, "for programs (docs/RESULTS.md)");
  return explain;
}

}  // namespace tcs
