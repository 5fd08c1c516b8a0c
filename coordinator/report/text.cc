#include "coordinator/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace tcs::report {

std::string Escaped(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        // Control characters are no part of XML.
        escaped += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? ' ' : c;
    }
  }
  return escaped;
}

std::string Significant(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return value == 0 ? "0" : "–";
  // What rounding makes of it decides: 9.996 is 10.0.
  const double scale = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(value))));
  const double rounded = std::round(value * scale) / scale;
  const int before_point = static_cast<int>(std::floor(std::log10(std::abs(rounded)))) + 1;
  if (before_point >= 5) return Grouped(std::llround(rounded));
  return fmt::format("{:.{}f}", rounded, std::clamp(digits - before_point, 0, 12));
}

std::string Grouped(std::int64_t value) {
  std::string digits = fmt::format("{}", value);
  const std::size_t sign = value < 0 ? 1 : 0;
  if (digits.size() - sign < 5) return digits;
  for (std::size_t at = digits.size() - 3; at > sign; at -= std::min<std::size_t>(3, at)) {
    digits.insert(at, "\u202f");
  }
  return digits;
}

std::string Seconds(double seconds, int digits) {
  if (seconds == 0) return "0 s";
  const double size = std::abs(seconds);
  // A unit begins where rounding reaches it.
  const double almost = 1.0 - 0.5 * std::pow(10.0, -digits);
  if (size >= almost) return Significant(seconds, digits) + " s";
  if (size >= almost * 1e-3) return Significant(seconds * 1e3, digits) + " ms";
  if (size >= almost * 1e-6) return Significant(seconds * 1e6, digits) + " µs";
  return Significant(seconds * 1e9, digits) + " ns";
}

std::string Percent(double share) {
  const double percent = 100.0 * share;
  if (percent == 0 || percent == 100) return fmt::format("{:.0f} %", percent);
  // What is not all or nothing does not look like it.
  if (percent > 99.5) return fmt::format("{:.1f} %", std::min(percent, 99.9));
  if (percent >= 10) return fmt::format("{:.0f} %", percent);
  return Significant(std::max(percent, 0.001), percent < 1 ? 1 : 2) + " %";
}

std::string Count(std::int64_t number, std::string_view of_what) {
  return fmt::format("{} {}{}", Grouped(number), of_what, number == 1 ? "" : "s");
}

std::string FileName(std::string_view text) {
  std::string name(text);
  for (char& c : name) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.';
    if (!plain) c = '-';
  }
  return name;
}

}  // namespace tcs::report
