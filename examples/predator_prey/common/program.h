// What the programs' main functions share: the command line, and errors as one line on stderr.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace predator_prey {

// Parses the command line and runs `body`. Returns the exit status: 0, 1 for an exception from
// `body`, 2 for a wrong argument.
int RunProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& body);

}  // namespace predator_prey
