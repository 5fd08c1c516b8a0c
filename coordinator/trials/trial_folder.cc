#include "coordinator/trials/trial_folder.h"

#include <poll.h>

#include <filesystem>
#include <system_error>

#include "coordinator/os/files.h"

namespace tcs {

namespace {

constexpr int kFolderLookMs = 200;
// A run that somebody killed ends within ten seconds (os/guardian.h).
constexpr int kDyingRunLooks = 75;

}  // namespace

std::string RemoveTrialFolder(const std::string& folder) {
  for (int look = 0; !FolderLock(folder).IsOurs(); ++look) {
    if (look == kDyingRunLooks) {
      return "an earlier run still writes to " + folder + "; end it";
    }
    poll(nullptr, 0, kFolderLookMs);
  }
  std::error_code error;
  std::filesystem::remove_all(folder, error);
  return error ? folder + " cannot be removed: " + error.message() : "";
}

std::string MakeTrialFolderAnew(const std::string& folder) {
  std::string error = RemoveTrialFolder(folder);
  return error.empty() ? MakeFolder(folder) : error;
}

}  // namespace tcs
