// What a trial's folder says of how it went.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tcs {

struct TrialOutcome {
  std::int64_t virtual_ns = 0, real_ns = 0, drift_ns = 0, staleness_ns = 0;
  double overhead_percent = 0.0;
};

// From the text of a summary.json; none unless the run with this seed went to its end and no client
// of it failed.
std::optional<TrialOutcome> OutcomeFromJson(const std::string& text, std::uint64_t seed);
// The same from the folder.
std::optional<TrialOutcome> ReadOutcome(const std::string& folder, std::uint64_t seed);

// The sentence out of what a run printed that says why it failed, without "tcsim: "; its last line
// if it says none; empty if it said nothing but warnings.
std::string LastWords(const std::string& said);

// The end of a file as text; empty if it cannot be read.
std::string ReadText(const std::string& path);

}  // namespace tcs
