// The options of `tcsim trials`.
#pragma once

#include "coordinator/cli/trials_command.h"

namespace CLI {
class App;
}

namespace tcs {

// Adds the command, which fills `arguments` in when it is parsed.
const CLI::App* AddTrials(CLI::App* app, TrialsArguments* arguments);

}  // namespace tcs
