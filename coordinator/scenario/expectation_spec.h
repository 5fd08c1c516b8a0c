// What a scenario expects of its run (`expect`), as it describes it: plain values, already checked.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "coordinator/measures/measure.h"

namespace tcs {

// One figure, and between what it is to be, both included.
struct ExpectationSpec {
  std::string place;    // "scenario.yaml:12: "
  std::string subject;  // as people read it: "hover/controller", "body drone", "metric error"
  std::string figure;   // "misses", "z"
  // Of a client, a chain, a metric or the run: its name among the run's Measures.
  std::string measure;
  // Of a body, a joint or a channel, which is looked at all the while: which of Scenario::kept.
  std::optional<std::size_t> kept;
  MeasureUnit unit = MeasureUnit::kNumber;  // seconds for durations
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  double share = 1;  // of trials, that it has to hold in
};

}  // namespace tcs
