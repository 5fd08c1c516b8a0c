#include "coordinator/report/expected_words.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

// The tally of one expectation, over all runs.
struct Tally {
  std::int64_t held = 0, runs = 0;
  std::string first_not;  // the outcome in the first run in which the expectation did not hold
};

// The tallies, in the scenario's order.
std::vector<std::pair<std::string, Tally>> TalliesOf(const System& system) {
  std::vector<std::pair<std::string, Tally>> all;
  std::map<std::pair<std::string, std::string>, std::size_t> places;
  for (const Run& run : system.runs) {
    for (const Expectation& one : run.expectations) {
      const auto [place, is_new] = places.try_emplace({one.subject, one.figure}, all.size());
      if (is_new) all.push_back({one.subject, {}});
      Tally& tally = all[place->second].second;
      ++tally.runs;
      tally.held += one.holds;
      if (!one.holds && tally.first_not.empty()) tally.first_not = one.what;
    }
  }
  return all;
}

}  // namespace

std::string ExpectedSentence(const System& system) {
  const auto tallies = TalliesOf(system);
  if (tallies.empty()) return {};
  std::size_t hold = 0;
  for (const auto& [subject, tally] : tallies) hold += tally.held == tally.runs;
  return fmt::format("{} of {} hold{}.", hold,
                     Count(static_cast<std::int64_t>(tallies.size()), "expectation"),
                     system.runs.size() > 1 ? " in all trials" : "");
}

std::vector<std::string> NotAsExpected(const System& system) {
  std::vector<std::string> sentences;
  for (const auto& [subject, tally] : TalliesOf(system)) {
    if (tally.held == tally.runs) continue;
    sentences.push_back(subject + ": " + tally.first_not);
    if (system.runs.size() > 1) {
      sentences.back() += fmt::format(" (held in {} of {} trials)", tally.held, tally.runs);
    }
  }
  return sentences;
}

}  // namespace tcs::report
