#include "coordinator/cli/manual/generate.h"

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/basics/version.h"
#include "coordinator/cli/manual/completion.h"
#include "coordinator/cli/manual/manual_page.h"
#include "coordinator/os/files.h"

namespace tcs {

int Generate(const DescribedCommand& program, const std::string& folder) {
  std::vector<std::pair<std::string, std::string>> files = {
      {program.name + ".1", ManualPage(program, "", program, kVersion)},
      {program.name, BashCompletion(program)},
      {"_" + program.name, ZshCompletion(program)}};
  for (const DescribedCommand& command : program.commands) {
    files.emplace_back(program.name + "-" + command.name + ".1",
                       ManualPage(command, program.name, program, kVersion));
  }
  for (const auto& [name, text] : files) {
    if (const std::string error = WriteWhole(folder + "/" + name, text, Withstands::kCrash);
        !error.empty()) {
      return Fail(error);
    }
  }
  return kSucceeded;
}

}  // namespace tcs
