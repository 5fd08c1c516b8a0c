// The output of `tcsim run` about the scenario's expectations, and about warnings under --strict.
#pragma once

#include <string>
#include <vector>

#include "coordinator/expect/judge.h"
#include "coordinator/expect/junit.h"
#include "coordinator/tasks/coordinator.h"

namespace tcs {

// Prints to stdout how many expectations hold, and how many are not judged (Scenario::not_judged).
// Expectations that do not hold go to stderr, the earliest first.
void PrintJudgements(const std::vector<Judgement>& judgements, std::size_t not_judged);

// Under --strict, before the run: says the scenario's warnings, and returns kCannotRun.
int RefuseWarnings(const Scenario& scenario);
// Under --strict, after the run: says that these warnings are errors. Says nothing if there are
// none.
void SayRefused(const std::vector<std::string>& warnings);

// The suite's cases: the clients, each of which ended well or not; the expectations; and the
// refused warnings.
[[nodiscard]] JunitSuite JunitSuiteOf(const Scenario& scenario, const RunReport& report,
                                      const std::vector<Judgement>& judgements,
                                      const std::vector<std::string>& refused);

}  // namespace tcs
