// A comparison for people, and for programs.
#pragma once

#include <string>

#include "coordinator/compare/judge.h"

namespace tcs::compare {

// A sentence for each figure that became worse (of many the greatest), a table of all figures that
// differ, and how many were compared. Warnings are not part of the text.
[[nodiscard]] std::string CompareText(const Side& a, const Side& b, const Comparison& comparison,
                                      const JudgeOptions& options);

// All figures (docs/TRIALS.md).
[[nodiscard]] std::string CompareJson(const Side& a, const Side& b, const Comparison& comparison,
                                      const JudgeOptions& options);

}  // namespace tcs::compare
