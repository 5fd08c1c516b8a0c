// `tcsim new`.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tcs {

struct NewArguments {
  std::string name;      // of the folder, which is made here, and of the robot
  std::string language;  // python or c; empty: Python where it is installed
};

// Adds the command, which fills `arguments` in when it is parsed.
const CLI::App* AddNew(CLI::App* app, NewArguments* arguments);

// Writes a scenario and a controller that fly, from the templates in DataFolder(). The exit status.
int NewCommand(const NewArguments& arguments);

}  // namespace tcs
