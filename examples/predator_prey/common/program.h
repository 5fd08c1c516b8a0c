// What the programs' main functions share: the command line, errors as one line on stderr, and
// waiting for several descriptors.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>

namespace predator_prey {

// Adds a required option for a UDP port of this machine.
void AddPort(CLI::App& app, const std::string& name, std::uint16_t& port, const std::string& help);

// Parses the command line and runs `body`. Returns the exit status: 0, 1 for an exception from
// `body`, 2 for a wrong argument.
int RunProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& body);

// Blocks until one of the descriptors has something to read. Throws std::system_error.
void WaitForAny(std::initializer_list<int> fds);

}  // namespace predator_prey
