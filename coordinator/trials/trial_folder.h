// The folder of one trial, before it is run.
#pragma once

#include <string>

namespace tcs {

// Nothing is there afterwards, and no run of before writes into it any more; waits some seconds for
// one that was killed. Empty on success, else one sentence.
[[nodiscard]] std::string RemoveTrialFolder(const std::string& folder);

// The same, and the folder is made.
[[nodiscard]] std::string MakeTrialFolderAnew(const std::string& folder);

}  // namespace tcs
