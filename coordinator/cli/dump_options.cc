#include <CLI/CLI.hpp>

#include "coordinator/cli/dump_command.h"

namespace tcs {

const CLI::App* AddDump(CLI::App* app, DumpArguments* arguments) {
  CLI::App* dump = app->add_subcommand(
      "dump", "what each part of a run that goes on does or waits for, as of a run that hangs");
  dump->add_option(
      "run", arguments->run,
      "FOLDER: that the run writes to, or the number of one of its processes; the only "
      "run unless told");
  dump->add_flag("--json", arguments->as_json, "for programs (docs/DEBUGGING.md)");
  return dump;
}

}  // namespace tcs
