// A measure in words.
#pragma once

#include <string>

#include "coordinator/measures/measure.h"

namespace tcs::report {

// "missed deadlines of r/planner", "response time (p99) of r/planner"; for a name of the user's
// own, the name.
[[nodiscard]] std::string MeasureWords(const std::string& measure);

// "12.5 ms", "3.1 %", "17".
[[nodiscard]] std::string MeasureText(double value, MeasureUnit unit);

}  // namespace tcs::report
