// The results of trials, in trials.json: after a call has ended, one line for each trial that is
// done.
#pragma once

#include <string>
#include <vector>

#include "coordinator/measures/measure.h"
#include "coordinator/trials/plan.h"

namespace tcs {

struct TrialResult {
  Trial trial;
  Measures measures;
};

// The text of a trials.json (record.h) with the results of `plan`'s trials instead of any results
// that the text has; the text as it was, if it is no trials.json.
[[nodiscard]] std::string WithResults(const std::string& record, const TrialsPlan& plan,
                                      const std::vector<TrialResult>& results);

// Reads the summaries of the trials that are done in the folder, and writes their figures into its
// trials.json. Empty on success, else the sentence.
[[nodiscard]] std::string WriteResults(const std::string& folder, const TrialsPlan& plan);

}  // namespace tcs
