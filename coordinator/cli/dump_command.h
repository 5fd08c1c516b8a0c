// `tcsim dump`.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tcs {

struct DumpArguments {
  std::string run;  // a folder or a process; empty: the only run
  bool as_json = false;
};

// The command's options; `arguments` outlives the application.
const CLI::App* AddDump(CLI::App* app, DumpArguments* arguments);

// The exit status.
int DumpCommand(const DumpArguments& arguments);

}  // namespace tcs
