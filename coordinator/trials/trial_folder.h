// The folder of one trial, before it is run.
#pragma once

#include <string>

namespace tcs {

// Removes the folder. No earlier run writes into it any more afterwards; waits some seconds for a
// run that was killed. Empty on success, else one sentence.
[[nodiscard]] std::string RemoveTrialFolder(const std::string& folder);

// The same, and the folder is made.
[[nodiscard]] std::string MakeTrialFolderAnew(const std::string& folder);

}  // namespace tcs
