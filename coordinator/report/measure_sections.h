// The figures and tables of measures against varied keys.
#pragma once

#include <string>
#include <vector>

#include "coordinator/report/figure.h"
#include "coordinator/report/measure_data.h"

namespace tcs::report {

struct MeasureParts {
  Figure figure;
  std::string table;  // of the same numbers, as HTML
  std::string text;   // the table for a terminal, under its title
};

[[nodiscard]] std::vector<MeasureParts> MeasureSections(const Results& results,
                                                        const MeasureRequest& request);

}  // namespace tcs::report
