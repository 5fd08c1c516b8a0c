#include "coordinator/cli/examples_text.h"

#include <CLI/CLI.hpp>
#include <array>
#include <utility>

namespace tcs {

namespace {

// A command, and pairs of lines: a command line, and what it is for. An empty name is tcsim itself.
constexpr std::array<std::pair<const char*, const char*>, 12> kExamples = {{
    {"",
     "tcsim new hover && cd hover && tcsim run\n"
     "a first robot: writes a scenario and a controller, and flies them\n"
     "tcsim exec -- sh -c 'date; sleep 3600; date'\n"
     "an hour in virtual time, which returns at once\n"
     "tcsim doctor\n"
     "what this machine allows, and how to mend what it does not"},
    {"new",
     "tcsim new hover\n"
     "the folder hover, with a controller in Python, ready to run\n"
     "tcsim new --language c hover\n"
     "the same with a controller in C, and a CMakeLists.txt for it"},
    {"check",
     "tcsim check\nreports every mistake of scenario.yaml in this folder\ntcsim check --set "
     "robots.drone.cpu.cores=4 scenario.yaml\nthe same with another value"},
    {"run",
     "tcsim run\n"
     "runs scenario.yaml in this folder, and writes to out\n"
     "tcsim run --set robots.drone.cpu.speed=0.5 --out slow scenario.yaml\n"
     "the same on a computer half as fast\n"
     "tcsim run --accounting fixed scenario.yaml\n"
     "two such runs are identical to the byte: for continuous integration\n"
     "tcsim run --gdb drone/controller scenario.yaml\n"
     "opens that client in gdb; virtual time stands still while gdb has stopped it"},
    {"trials",
     "tcsim trials --trials 100 scenario.yaml\n"
     "a hundred seeds, several at once; called again it goes on where it ended\n"
     "tcsim trials --trials 10 --vary robots.drone.cpu.speed=0.5,1,2 scenario.yaml\n"
     "ten seeds for each of three processors\n"
     "tcsim trials --trials 5 --vary robots.drone.cpu.speed=0.5,1 --vary "
     "robots.drone.cpu.cores=1,2\n"
     "five seeds for each speed with each number of cores\n"
     "tcsim trials --trials 200 --out /shared/t --launcher slurm --slurm-option=--partition=short\n"
     "on a cluster's nodes, which all see /shared"},
    {"exec",
     "tcsim exec -- python3 program.py\n"
     "any program, with the same input, output and exit status\n"
     "tcsim exec --speed 0.5 --cores 4 -- bash session.sh\n"
     "on a computer with four processors half as fast"},
    {"report",
     "tcsim report out\n"
     "one page of a run, report.html\n"
     "tcsim report --figures svg slow fast\n"
     "one page of two, and each figure as a file\n"
     "tcsim report --measure controller.misses --against cpu.speed trials\n"
     "missed deadlines against the processor's speed, of trials that vary it"},
    {"compare",
     "tcsim compare before after\n"
     "what became worse between two sets of trials; exit status 3 if something did\n"
     "tcsim compare --tolerance 10% --measure planner before after\n"
     "only the planner's figures, of which each may be a tenth worse"},
    {"explain",
     "tcsim explain out\n"
     "the five activations that were most late, and what their time went into\n"
     "tcsim explain out drone/controller --at 3.12s\n"
     "what that client was at then"},
    {"topics", "tcsim topics --qos out\nall DDS topics of a run, with both ends of each"},
    {"dump",
     "tcsim dump\n"
     "of the only run that goes on: who runs, and who waits for what\n"
     "tcsim dump --json out\n"
     "of the run that writes to out, for programs"},
    {"fit",
     "tcsim run --for-fit --out measured scenario.yaml && tcsim fit --out costs.yaml measured\n"
     "the costs with which `--accounting fixed --overlay costs.yaml` takes the time that was "
     "measured"},
}};

}  // namespace

void AddExamples(CLI::App* app) {
  for (const auto& [name, text] : kExamples) {
    if (*name == '\0') app->footer(text);
    for (CLI::App* command : app->get_subcommands(nullptr)) {
      if (command->get_name() == name) command->footer(text);
    }
  }
}

}  // namespace tcs
