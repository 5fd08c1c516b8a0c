// The command line's description of itself, read from CLI11's tree: the one source of `--help`, the
// manual pages and the shells' completions. An option is described once, where it is added.
//
// The text of an option or an argument may begin with the name of its value in capitals and a
// colon, such as "FILE: a piece of a scenario"; else the value's name is what CLI11 calls its type.
// FILE and FOLDER are completed as such by the shells. A command's footer is its examples, as pairs
// of lines: the command line, and what it is for.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tcs {

struct DescribedOption {
  std::vector<std::string> names;    // with their dashes; of an argument its name alone
  std::string value;                 // the value's name; empty: takes none
  std::vector<std::string> choices;  // of the value; empty: anything
  std::string text;                  // a sentence without a full stop
  std::string unless_told;           // the option's default value; empty: not said
  bool is_required = false;
  bool repeats = false;
};

struct DescribedExample {
  std::string line, purpose;
};

struct DescribedCommand {
  std::string name, text;  // of the program itself: "tcsim"
  std::vector<DescribedOption> arguments, options;
  std::vector<DescribedExample> examples;
  std::vector<DescribedCommand> commands;
};

// Describes the program with its commands. An option or a command in no group is not for people,
// and left out.
[[nodiscard]] DescribedCommand Describe(const CLI::App& app);

// "tcsim run [OPTIONS] [scenario]"; `parent`: the name of the program, empty for the program.
[[nodiscard]] std::string UsageOf(const DescribedCommand& command, const std::string& parent);

// "--set KEY=VALUE", "-h, --help", "scenario".
[[nodiscard]] std::string Heading(const DescribedOption& option);

// The text, and the default behind it where there is one.
[[nodiscard]] std::string FullText(const DescribedOption& option);

}  // namespace tcs
