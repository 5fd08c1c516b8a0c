// How far the trials are, and what they came to, in words. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/trials/outcome.h"

namespace tcs {

struct TrialsProgress {
  struct Running {
    double seconds = 0.0;   // since the trial's start
    double fraction = 0.0;  // of the trial's virtual time
  };
  int total = 0, done = 0, failed = 0;
  std::vector<Running> running;
  std::vector<double> finished_seconds;  // of the trials that are done, how long each took
  double elapsed_seconds = 0.0;
  int at_once = 1;
  int queued = 0;  // jobs of a cluster that have not begun
};

// The time still to wait, in seconds; none while nothing is known.
std::optional<double> RemainingSeconds(const TrialsProgress& progress);

// A line with a bar, of at most `columns` bytes.
std::string ProgressLine(const TrialsProgress& progress, std::size_t columns);

// Outcomes of the trials of one value that are done.
struct TrialsGroup {
  std::string label;
  int trials = 0;
  std::vector<TrialOutcome> done;
};

// A row for each group, with a head.
std::string TrialsTable(const std::vector<TrialsGroup>& groups);

// "0 ns", "1.000 ms", "168.000 s"
std::string AsSpan(std::int64_t ns);

}  // namespace tcs
