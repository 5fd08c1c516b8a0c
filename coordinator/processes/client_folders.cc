#include "coordinator/processes/client_folders.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "coordinator/os/files.h"

namespace tcs {

namespace {

std::string PrepareFolder(const ClientSpec& client) {
  const std::string& folder = client.working_directory;
  std::error_code not_removed;
  if (client.folder == ClientFolder::kThere) return {};
  if (client.folder == ClientFolder::kFresh) std::filesystem::remove_all(folder, not_removed);
  if (not_removed) {
    return fmt::format(
        "the folder '{}' of an earlier run cannot be removed: {}; choose another "
        "one with --out",
        folder, not_removed.message());
  }
  std::string error = MakeFolder(folder);
  if (error.empty() && !client.copied_folder.empty()) {
    error = CopyFolder(client.copied_folder, folder);
  }
  return error;
}

}  // namespace

// A client that is never started has no log.
std::string PrepareFolders(const Scenario& scenario, const RunOptions& options) {
  for (const RobotSpec& robot : scenario.robots) {
    for (const ClientSpec& client : robot.clients) {
      for (const char* log : {".out.log", ".err.log"}) {
        std::error_code ignored;
        const std::string base = options.output_directory + "/" + FileNameOf(client);
        if (!options.output_directory.empty()) std::filesystem::remove(base + log, ignored);
      }
      if (std::string error = PrepareFolder(client); !error.empty()) return error;
    }
  }
  return {};
}

}  // namespace tcs
