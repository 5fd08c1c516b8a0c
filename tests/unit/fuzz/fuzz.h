// The kinds of input that are damaged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace tcs::fuzz {

// Numbers of what became of damaged inputs, and of those that it went wrong with.
struct Tally {
  int taken = 0, refused = 0, wrong = 0;

  // Counts one attempt, in a process of its own (attempt.h): it says whether the input was refused,
  // and returns what is wrong with how that went, or nothing. Returns what went wrong, if anything.
  std::optional<std::string> Count(const std::function<std::string(bool* refused)>& attempt);
};

// Scenario files: loaded, but not run. A refusal begins with the file and the line.
Tally FuzzScenarios(int count, std::uint64_t seed);

// Result folders: made into a page, fitted, and given to each other command that looks at one. A
// refusal names the folder.
Tally FuzzResults(int count, std::uint64_t seed);

// Robots' files, and their meshes: loaded, and moved on each engine that takes them. A refusal
// names the file.
Tally FuzzModels(int count, std::uint64_t seed);

// Sound robots some of whose values and elements are others, as draughtsmen and exporters leave
// them: the same, for longer.
Tally FuzzRobots(int count, std::uint64_t seed);

// The bytes of a file.
std::string TextOf(const std::filesystem::path& path);

// Says on stderr what went wrong, and keeps the input as a file that it names.
void SayWrong(const std::string& what, int number, const std::string& wrong,
              const std::string& input);

}  // namespace tcs::fuzz
