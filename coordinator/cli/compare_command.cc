#include "coordinator/cli/compare_command.h"

#include <fmt/format.h>

#include <optional>
#include <variant>

#include "coordinator/cli/basics/exit_status.h"
#include "coordinator/cli/print.h"
#include "coordinator/compare/judge.h"
#include "coordinator/compare/read_side.h"
#include "coordinator/compare/words.h"
#include "coordinator/errors/visible.h"
#include "coordinator/text/csv.h"

namespace tcs {

namespace {

// Reads "5%", "5 %" or "0.05"; none if the text has neither form. "5" may be meant as either.
std::optional<double> ShareOf(std::string text) {
  const bool is_percent = !text.empty() && text.back() == '%';
  if (is_percent) text.pop_back();
  while (!text.empty() && text.back() == ' ') text.pop_back();
  const auto number = ToReal(text);
  if (!number || *number < 0 || (!is_percent && *number >= 1)) return {};
  return is_percent ? *number / 100 : *number;
}

}  // namespace

int CompareCommand(const CompareArguments& arguments) {
  compare::JudgeOptions options;
  const auto tolerance = ShareOf(arguments.tolerance);
  if (!tolerance) {
    return Fail("--tolerance: '" + arguments.tolerance + "' is no share; write it like 5% or 0.05");
  }
  options.tolerance = *tolerance;
  const auto confidence = ShareOf(arguments.confidence);
  if (!confidence || *confidence <= 0.5 || *confidence >= 1) {
    return Fail("--confidence: '" + arguments.confidence +
                "' is no share between 50% and 100%; write it like 99% or 0.99");
  }
  options.confidence = *confidence;
  options.measures = arguments.measures;
  options.more_is_better = arguments.more_is_better;
  options.less_is_better = arguments.less_is_better;

  const auto before = compare::ReadSide(arguments.before);
  if (const auto* error = std::get_if<LoadError>(&before)) return Fail(error->message);
  const auto after = compare::ReadSide(arguments.after);
  if (const auto* error = std::get_if<LoadError>(&after)) return Fail(error->message);
  const auto& a = std::get<compare::Side>(before);
  const auto& b = std::get<compare::Side>(after);
  if (const std::string why = WhyNotComparable(a, b, options); !why.empty()) return Fail(why);
  const compare::Comparison comparison = compare::Judge(a, b, options);
  for (const std::string& warning : comparison.warnings) Say("warning: " + warning);
  const std::string text = arguments.as_json ? CompareJson(a, b, comparison, options)
                                             : VisibleLines(CompareText(a, b, comparison, options));
  Print("{}", text);
  return comparison.IsWorse() ? kExpectationFailed : kSucceeded;
}

}  // namespace tcs
