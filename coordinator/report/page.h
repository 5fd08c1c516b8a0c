// The page: one HTML document that needs nothing else, with script or without.
#pragma once

#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/report/measure_data.h"
#include "coordinator/report/results.h"

namespace tcs::report {

struct PageOptions {
  std::string title;          // empty: the scenario's name
  std::vector<double> marks;  // distances that figures mark, in metres
  MeasureRequest measures;    // measures against varied keys
};

struct Page {
  std::string html;
  std::string text;  // the page's first tables, for a terminal
  // The figures by themselves, by file name without its extension.
  std::vector<std::pair<std::string, std::string>> svgs;
  std::vector<std::string> warnings;  // one sentence each; the results' warnings are among them
};

[[nodiscard]] Page MakePage(const Results& results, const PageOptions& options);

}  // namespace tcs::report
