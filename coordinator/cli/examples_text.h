// The examples that `--help` and the manual pages show for each command.
#pragma once

namespace CLI {
class App;
}

namespace tcs {

// Gives each command that is there its examples, as its footer (manual/description.h).
void AddExamples(CLI::App* app);

}  // namespace tcs
