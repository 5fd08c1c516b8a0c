// The output of `tcsim trials` about the scenario's expectations, and about warnings under
// --strict.
#pragma once

#include <string>
#include <vector>

#include "coordinator/expect/over_trials.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/trials/plan.h"

namespace tcs {

struct JudgedTrials {
  std::vector<TrialsJudgement> judgements;  // the groups in turn
  std::vector<std::string> refused;         // under --strict: "seed 3: the warning"

  [[nodiscard]] bool IsAsExpected() const;
};

// Judges the trials in the folder that are done; `scenarios` are those of the groups.
[[nodiscard]] JudgedTrials JudgeTrials(const TrialsPlan& plan,
                                       const std::vector<Scenario>& scenarios,
                                       const std::string& folder, bool strict);

// Prints to stdout how many expectations hold. Expectations that do not hold, and warnings that are
// refused, go to stderr.
void PrintJudged(const JudgedTrials& judged);

// Empty on success, else the sentence. `failures`: the sentences of the trials that are not done.
[[nodiscard]] std::string WriteJunit(const std::string& path, const TrialsPlan& plan,
                                     const JudgedTrials& judged,
                                     const std::vector<std::string>& failures);

}  // namespace tcs
