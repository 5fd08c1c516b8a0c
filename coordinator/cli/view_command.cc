#include "coordinator/cli/view_command.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/preload_library.h"
#include "coordinator/os/files.h"
#include "coordinator/view/launch.h"

namespace tcs {

int ViewCommand(const std::string& folder, const std::string& where) {
  ViewRequest request{.server = ViewServer(), .folder = AbsolutePathOf(folder)};
  if (const std::string error = TakeViewAddress(where, &request); !error.empty()) {
    return Fail("--at: " + error);
  }
  std::error_code error;
  bool is_of_run = false;
  // A run that goes on has no summary yet, one without bodies no scene.
  for (const char* file : {"summary.json", "unfinished.json", "scene.json", "dispatches.csv"}) {
    is_of_run |=
        std::filesystem::is_regular_file(std::filesystem::path(request.folder) / file, error);
  }
  if (!is_of_run) {
    return Fail("in the folder '" + folder +
                "' is no result of `tcsim run`; give the folder that was its --out");
  }
  const std::string port = std::to_string(request.port);
  execl(request.server.c_str(), request.server.c_str(), request.folder.c_str(),
        request.address.c_str(), port.c_str(), nullptr);
  return Fail("the server of the page, " + request.server +
              ", cannot be started: " + strerror(errno) + "; build tcs again");
}

}  // namespace tcs
