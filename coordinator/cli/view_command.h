// `tcsim view`.
#pragma once

#include <string>

namespace tcs {

// Shows a folder at `where` (view/launch.h), until the server is ended. The exit status.
int ViewCommand(const std::string& folder, const std::string& where);

}  // namespace tcs
