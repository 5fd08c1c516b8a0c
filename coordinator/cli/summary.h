// The summary at a run's end: a few lines for people, and summary.json for programs.
#pragma once

#include <string>
#include <vector>

#include "coordinator/expect/judge.h"
#include "coordinator/tasks/coordinator.h"

namespace tcs {

// Coordinating time in percent of the run's real time.
double OverheadPercent(const RunReport& report);

// True if a client ended before the run with anything but exit status 0.
bool HasFailedClient(const RunReport& report);

// Prints to stdout; what went wrong in clients goes to stderr.
void PrintSummary(const Scenario& scenario, const RunReport& report, const std::string& directory);

// As JSON; times are nanoseconds.
std::string SummaryText(const Scenario& scenario, const RunOptions& options,
                        const RunReport& report, const std::vector<Judgement>& judgements = {});

}  // namespace tcs
