#include "coordinator/cli/check_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <variant>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/expected.h"
#include "coordinator/cli/print.h"
#include "coordinator/errors/visible.h"
#include "coordinator/os/files.h"
#include "coordinator/scenario/load.h"
#include "coordinator/world/world.h"

namespace tcs {

const CLI::App* AddCheck(CLI::App* app, CheckArguments* arguments) {
  CLI::App* check = app->add_subcommand(
      "check", "report every mistake of a scenario and of the files that it names");
  check->add_option("scenario", arguments->scenario, "FILE: the YAML file (docs/SCENARIO.md)")
      ->capture_default_str();
  check
      ->add_option("--overlay", arguments->overlays,
                   "FILE: a piece of a scenario whose values replace the scenario's; repeatable")
      ->allow_extra_args(false);
  check
      ->add_option("--set", arguments->set,
                   "KEY=VALUE: another value for a key of the scenario; repeatable")
      ->allow_extra_args(false);
  check->add_flag("--strict", arguments->strict, "each warning is an error, too: exit status 2");
  check->add_flag("-v,--verbose", arguments->verbose,
                  "list all that was mended in files of robots, where a warning names one of them");
  return check;
}

int SaySound(const Scenario& scenario, bool strict) {
  if (strict && !scenario.warnings.empty()) return RefuseWarnings(scenario);
  for (const std::string& warning : scenario.warnings) Say("warning: " + warning);
  if (const std::string error = WhyNoWorld(scenario); !error.empty()) return Fail(error);
  std::size_t clients = 0;
  for (const RobotSpec& robot : scenario.robots) clients += robot.clients.size();
  const std::size_t bodies = scenario.world.has_value() ? scenario.world->bodies.size() : 0;
  const std::size_t models = scenario.world.has_value() ? scenario.world->models.size() : 0;
  Print("{} is sound: robots {}, clients {}, bodies {}{}\n", Visible(scenario.path),
        scenario.robots.size(), clients, bodies,
        models > 0 ? fmt::format(", models {}", models) : "");
  return kSucceeded;
}

int CheckCommand(const CheckArguments& arguments) {
  ScenarioOverrides overrides;
  overrides.overlays = arguments.overlays;
  overrides.set = arguments.set;
  overrides.result_directory = AbsolutePathOf("out");
  const auto checked = CheckScenario(arguments.scenario, overrides);
  if (const auto* scenario = std::get_if<Scenario>(&checked)) {
    if (arguments.verbose) {
      for (const std::string& detail : scenario->details) Say("mended: " + detail);
    }
    return SaySound(*scenario, arguments.strict);
  }
  for (const LoadError& mistake : std::get<std::vector<LoadError>>(checked)) Say(mistake.message);
  return kCannotRun;
}

}  // namespace tcs
