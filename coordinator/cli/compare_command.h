// `tcsim compare`.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tcs {

struct CompareArguments {
  std::string before, after;  // folders
  std::string tolerance = "5%", confidence = "99%";
  std::vector<std::string> measures, more_is_better, less_is_better;
  bool as_json = false;
};

// Adds the command, which fills `arguments` in when it is parsed (compare_options.cc).
const CLI::App* AddCompare(CLI::App* app, CompareArguments* arguments);

// The exit status: 3 if something became worse.
int CompareCommand(const CompareArguments& arguments);

}  // namespace tcs
