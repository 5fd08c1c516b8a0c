// What `tcsim run` says of the scenario's expectations, and of warnings under --strict.
#pragma once

#include <string>
#include <vector>

#include "coordinator/expect/judge.h"
#include "coordinator/expect/junit.h"
#include "coordinator/tasks/coordinator.h"

namespace tcs {

// How many hold, and how many are not judged (Scenario::not_judged), to stdout; those that do not,
// to stderr, the first one first.
void PrintJudgements(const std::vector<Judgement>& judgements, std::size_t not_judged);

// Under --strict, before the run: says the scenario's warnings, and returns kCannotRun.
int RefuseWarnings(const Scenario& scenario);
// After it: that these are errors. Nothing if there are none.
void SayRefused(const std::vector<std::string>& warnings);

// The clients, each of which ended well or not; the expectations; and, refused, the warnings.
[[nodiscard]] JunitSuite JunitSuiteOf(const Scenario& scenario, const RunReport& report,
                                      const std::vector<Judgement>& judgements,
                                      const std::vector<std::string>& refused);

}  // namespace tcs
