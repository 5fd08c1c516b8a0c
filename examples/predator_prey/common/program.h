// What the programs' main functions share: the command line, and errors as one line on stderr.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

// Its headers take longer to compile than all else here, so only program.cc has them.
namespace CLI {
class App;
}

namespace predator_prey {

enum class Accept { kAll, kNotNegative, kPositive };

// The options of a program. The variables that they set have to live until Run() returns, and hold
// the defaults, which --help shows.
class CommandLine {
 public:
  CommandLine(const std::string& description, const std::string& name);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  void Add(const char* name, double& value, const char* help, Accept accept);
  void Add(const char* name, std::uint64_t& value, const char* help, Accept accept);
  void Add(const char* name, std::uint32_t& value, const char* help, Accept accept);
  void AddBetween(const char* name, double& value, const char* help, double least, double most);
  // `what_is_wrong` returns a sentence, or "".
  void AddText(const char* name, std::string& value, const char* help,
               const std::function<std::string(const std::string&)>& what_is_wrong);
  // Without a default of its own.
  void AddUnlessTold(const char* name, std::uint32_t& value, const char* help, int least, int most);
  // One that must be given.
  void AddPort(const char* name, std::uint16_t& value, const char* help);

  // Parses the command line and runs `body`. Returns the exit status: 0, 1 for an exception from
  // `body`, 2 for a wrong argument.
  int Run(int argc, char** argv, const std::function<void()>& body);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace predator_prey
