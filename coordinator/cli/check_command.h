// `tcsim check`.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tcs {

struct Scenario;

struct CheckArguments {
  std::string scenario = "scenario.yaml";
  std::vector<std::string> overlays;  // files
  std::vector<std::string> set;       // KEY=VALUE
  bool strict = false;                // each warning is an error
  bool verbose = false;               // list each thing that a warning is about
};

// Adds the command, which fills `arguments` in when it is parsed.
const CLI::App* AddCheck(CLI::App* app, CheckArguments* arguments);

// Says all that is wrong with the scenario, each in a sentence with its place on stderr, or that it
// is sound. The exit status.
int CheckCommand(const CheckArguments& arguments);

// Says that the scenario is sound, and what it has. Warnings go to stderr; `strict` makes them
// errors. The exit status.
int SaySound(const Scenario& scenario, bool strict);

}  // namespace tcs
