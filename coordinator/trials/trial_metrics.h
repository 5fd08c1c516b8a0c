// The metrics of all trials at one place: in trials.json, by the trials' folders.
#pragma once

#include <string>
#include <vector>

namespace tcs {

// Takes those of the trials from their summaries; `trials` are folders beneath `folder`. Where none
// has metrics, nothing changes. Empty on success, else one sentence.
[[nodiscard]] std::string NoteTrialMetrics(const std::string& folder,
                                           const std::vector<std::string>& trials);

}  // namespace tcs
