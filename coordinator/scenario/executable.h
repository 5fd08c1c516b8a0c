// Finding the program that a command names, and telling whether tcs can run it. Both functions read
// the file system, and run nothing. Errors are sentences for the user.
#pragma once

#include <optional>
#include <string>

#include "coordinator/errors/load_error.h"

namespace tcs {

// The absolute path of the program `name`: relative to the absolute folder `cwd` if the name has a
// slash, else searched along tcsim's own PATH. A path that is found is executable, but not checked
// otherwise.
[[nodiscard]] LoadResult<std::string> FindExecutable(const std::string& name,
                                                     const std::string& cwd);

// Why tcs cannot carry the program at `path`, if it cannot. A program lives in virtual time through
// a preloaded library, so it must be a dynamically linked x86-64 ELF file that the loader does not
// treat as privileged; of a script, its interpreter must be one.
[[nodiscard]] std::optional<LoadError> CheckExecutable(const std::string& path);

}  // namespace tcs
