// An expectation of a scenario of its run (`expect`), as the scenario describes it: plain values,
// already checked.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "coordinator/measures/measure.h"

namespace tcs {

// A figure, and the bounds between which the figure is to be, both included.
struct ExpectationSpec {
  std::string place;    // "scenario.yaml:12: "
  std::string subject;  // as people read it: "hover/controller", "body drone", "metric error"
  std::string figure;   // "misses", "z"
  // For a client, a chain, a metric or the run: the figure's name among the run's Measures.
  std::string measure;
  // For a body, a joint or a channel, which is looked at all the while: the index in
  // Scenario::kept.
  std::optional<std::size_t> kept;
  MeasureUnit unit = MeasureUnit::kNumber;  // seconds for durations
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  double share = 1;  // of trials in which the expectation has to hold
};

}  // namespace tcs
