// `tcsim explain`.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tcs {

struct ExplainArguments {
  std::string folder;
  std::string client;  // or a chain; empty: all clients
  int worst = 5;
  std::string at;  // a time; empty: any
  bool as_json = false;
};

// The command's options; `arguments` outlives the application.
const CLI::App* AddExplain(CLI::App* app, ExplainArguments* arguments);

// The exit status.
int ExplainCommand(const ExplainArguments& arguments);

}  // namespace tcs
