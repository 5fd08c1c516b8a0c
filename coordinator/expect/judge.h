// Whether a run came to what its scenario expects (`expect`). Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/metrics/metric_figures.h"
#include "coordinator/scenario/expectation_spec.h"

namespace tcs {

struct Judgement {
  ExpectationSpec expected;
  bool holds = false;
  // The figure's value; for a figure that is looked at all the while, its range from `value` to
  // `largest`. None: not known.
  std::optional<double> value, largest;
  std::int64_t first_time_ns = -1;  // of the first miss or breach; -1: there is none, or not known
  std::string what;                 // "misses was 17, expected at most 0, first at 0.310 s"
};

// The judgement of each expectation, in their order. `summary` is the text of the run's
// summary.json, `kept` are the figures of Scenario::kept. An expectation whose figure is not known
// does not hold.
[[nodiscard]] std::vector<Judgement> JudgeRun(const std::vector<ExpectationSpec>& expectations,
                                              const std::string& summary, const MetricsOfRun& kept);

// The judgements that do not hold: first those with a time, the earliest first.
[[nodiscard]] std::vector<const Judgement*> Failed(const std::vector<Judgement>& judgements);

// "body drone: z …", and where it is expected.
[[nodiscard]] std::string SentenceOf(const Judgement& judgement);

// "at most 5 ms", "from 0.9 to 1.1".
[[nodiscard]] std::string BoundText(const ExpectationSpec& expected);

}  // namespace tcs
