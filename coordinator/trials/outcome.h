// The outcome of a trial, as its folder tells it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tcs {

struct TrialOutcome {
  std::int64_t virtual_ns = 0, real_ns = 0, drift_ns = 0, staleness_ns = 0;
  double overhead_percent = 0.0;
};

// The outcome in the text of a summary.json; none unless the run with this seed went to its end and
// none of its clients failed.
std::optional<TrialOutcome> OutcomeFromJson(const std::string& text, std::uint64_t seed);
// The outcome in the folder's summary.json.
std::optional<TrialOutcome> ReadOutcome(const std::string& folder, std::uint64_t seed);

// The sentence in a run's output that says why the run failed, without "tcsim: "; the output's last
// line if no sentence says so; empty if the run said nothing but warnings.
std::string LastWords(const std::string& said);

// The end of a file as text; empty if it cannot be read.
std::string ReadText(const std::string& path);

}  // namespace tcs
