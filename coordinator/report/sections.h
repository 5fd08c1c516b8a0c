// The parts of a report: a table or a figure of the results, and the sentence that says what it
// shows. Every sentence is computed from the data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/results.h"
#include "coordinator/report/timeline.h"

namespace tcs::report {

// A table under a heading; `text` is the table alone, for a terminal.
struct Section {
  std::string heading, sentence, html, text;
};

// None where the results have nothing of the kind.
[[nodiscard]] std::optional<Section> SystemsSection(const Results& results,
                                                    const std::vector<double>& marks);
[[nodiscard]] std::optional<Figure> DistanceHistogram(const Results& results,
                                                      const std::vector<double>& marks);
[[nodiscard]] std::optional<Figure> DistanceOverTime(const Results& results,
                                                     const std::vector<double>& marks);
[[nodiscard]] std::optional<Section> CostsSection(const Results& results);
[[nodiscard]] std::optional<Figure> TimelineFigure(const std::vector<Timeline>& timelines);
[[nodiscard]] std::optional<Figure> ResponseTimes(const Results& results);
[[nodiscard]] std::optional<Section> ClientsSection(const Results& results);
// One figure (where there are bodies) and one table per key that was varied.
[[nodiscard]] std::vector<std::string> VariedKeys(const Results& results);
[[nodiscard]] std::optional<Figure> SweepFigure(const Results& results, const std::string& key,
                                                const std::vector<double>& marks);
[[nodiscard]] Section SweepSection(const Results& results, const std::string& key,
                                   const std::vector<double>& marks);

}  // namespace tcs::report
