// Reads from a summary how well clients kept up.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "coordinator/report/results.h"

namespace tcs::report {

// Fills the verdict, the warnings, the expectations, the chains, and of each client of `run` its
// deadline and times. A field that the summary lacks stays as it is; throws where something is not
// what it should be.
void TakeAnswers(const nlohmann::json& summary, Run* run);

}  // namespace tcs::report
