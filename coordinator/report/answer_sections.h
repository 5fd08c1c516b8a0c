// The answers, which a page begins with: the verdict, who was in time, and why the worst was late.
// Of a system with several runs the verdict and the explanations are those of its first run, and
// the tables are over all runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/explain/told.h"
#include "coordinator/report/results.h"
#include "coordinator/report/sections.h"

namespace tcs::report {

// The inner HTML of the verdict: its sentences, or that all deadlines were met. Empty without
// systems.
[[nodiscard]] std::string VerdictHtml(const Results& results);

[[nodiscard]] std::optional<Section> InTimeSection(const Results& results);
[[nodiscard]] std::optional<Section> ChainsSection(const Results& results);

// A system, with what was told of its first run, or nothing.
struct ToldOf {
  const System* system;
  std::optional<explain::Told> told;
};

// The five worst activations of each system, and the worst command of each late chain: a sentence,
// and what the time went into. Empty where nothing was late.
[[nodiscard]] std::string ExplainedHtml(const Results& results, const std::vector<ToldOf>& all);

}  // namespace tcs::report
