// `tcsim report`.
#pragma once

#include <string>
#include <vector>

namespace tcs {

struct ReportArguments {
  std::vector<std::string> folders;
  std::string out = "report.html", figures, bodies, title;
  std::vector<double> marks;
  std::vector<std::string> measures;
  std::string against;
};

// The exit status.
int ReportCommand(const ReportArguments& arguments);

}  // namespace tcs
