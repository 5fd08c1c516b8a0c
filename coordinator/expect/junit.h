// JUnit XML, as continuous integration reads it: a suite of cases, each passed or failed. Pure.
#pragma once

#include <string>
#include <vector>

#include "coordinator/expect/judge.h"

namespace tcs {

struct JunitCase {
  std::string class_name, name;
  std::string failure;  // one sentence; empty: passed
  std::string details;  // more lines of a failure
};

struct JunitSuite {
  std::string name;
  double seconds = 0;  // real time
  std::vector<JunitCase> cases;
};

// The whole file. Characters that XML does not have become '?'.
[[nodiscard]] std::string JunitText(const std::vector<JunitSuite>& suites);

// A case for each expectation.
[[nodiscard]] std::vector<JunitCase> JunitCases(const std::vector<Judgement>& judgements);

}  // namespace tcs
