#include "coordinator/report/measure_words.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

// The part of a measure's name behind the last dot, in words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kMeasureWords = {{
    {"missed", "missed deadlines"},
    {"misses", "missed deadlines"},
    {"misses_in_a_row", "deadlines missed in a row"},
    {"response", "response time"},
    {"start_delay", "start delay"},
    {"execution", "execution time"},
    {"command_age", "age of commands"},
    {"age", "age"},
    {"lost", "lost samples"},
    {"replaced", "replaced samples"},
    {"unread", "unread samples"},
    {"backlog", "greatest backlog"},
}};

std::string MeasureWordOf(std::string_view figure) {
  for (const auto& [name, words] : kMeasureWords) {
    if (figure == name) return std::string(words);
    for (const std::string_view quantile : {"_p50", "_p99", "_max"}) {
      if (figure == std::string(name) + std::string(quantile)) {
        return fmt::format("{} ({})", words, quantile.substr(1));
      }
    }
  }
  return {};
}

}  // namespace

std::string MeasureWords(const std::string& measure) {
  const std::size_t dot = measure.rfind('.');
  if (dot == std::string::npos) return measure;
  const std::string words = MeasureWordOf(std::string_view(measure).substr(dot + 1));
  return words.empty() ? measure : fmt::format("{} of {}", words, measure.substr(0, dot));
}

std::string MeasureText(double value, MeasureUnit unit) {
  switch (unit) {
    case MeasureUnit::kSeconds:
      return value < 0 ? "-" + Seconds(-value) : Seconds(value);
    case MeasureUnit::kShare:
      return Percent(value);
    case MeasureUnit::kCount:
    case MeasureUnit::kNumber:
      break;
  }
  return fmt::format("{:.4g}", value);
}

}  // namespace tcs::report
