#include "coordinator/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace tcs::report {

namespace {

constexpr std::string_view kNoBreakSpace = "\u00a0", kReplacement = "\ufffd";

// Bytes of the first character of `text`, which is not empty; 0 if that is no UTF-8.
std::size_t LengthOfCharacter(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80                      ? 1
                             : byte(0) >= 0xC2 && byte(0) < 0xE0 ? 2
                             : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                             : byte(0) >= 0xF0 && byte(0) < 0xF5 ? 4
                                                                 : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Characters that are too long for what they say, halves of pairs, and characters beyond the last
  // one.
  if ((byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xED && byte(1) > 0x9F) ||
      (byte(0) == 0xF0 && byte(1) < 0x90) || (byte(0) == 0xF4 && byte(1) > 0x8F)) {
    return 0;
  }
  return length;
}

// Empty for a character that may stand as it is.
std::string_view EntityFor(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

}  // namespace

std::string Escaped(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = LengthOfCharacter(text.substr(i));
    const char c = text[i];
    if (length == 0) {
      escaped += kReplacement;
    } else if (const std::string_view entity = EntityFor(c); !entity.empty()) {
      escaped += entity;
    } else if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') {
      escaped += ' ';  // control characters are no part of XML
    } else {
      escaped += text.substr(i, length);
    }
    i += std::max<std::size_t>(1, length);
  }
  return escaped;
}

std::string Significant(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return value == 0 ? "0" : "–";
  // The rounded value decides: 9.996 is 10.0.
  const double places = digits - 1 - std::floor(std::log10(std::abs(value)));
  const double scale = std::pow(10.0, std::max(0.0, places));
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

std::string Plain(double value) {
  std::string text = Significant(value);
  if (text.find('.') == std::string::npos) return text;
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string WithUnit(const std::string& number, std::string_view unit) {
  return fmt::format("{}{}{}", number, kNoBreakSpace, unit);
}

std::string Seconds(double seconds, int digits) {
  if (seconds == 0) return WithUnit("0", "s");
  const double size = std::abs(seconds);
  // A unit begins where rounding reaches it.
  const double almost = 1.0 - 0.5 * std::pow(10.0, -digits);
  constexpr std::pair<double, std::string_view> kUnits[] = {{1, "s"}, {1e-3, "ms"}, {1e-6, "µs"}};
  for (const auto& [unit, name] : kUnits) {
    if (size >= almost * unit) return WithUnit(Significant(seconds / unit, digits), name);
  }
  return WithUnit(Significant(seconds * 1e9, digits), "ns");
}

std::string Metres(double value) { return WithUnit(Significant(value), "m"); }

std::string PlainMetres(double value) { return WithUnit(Plain(value), "m"); }

std::string Percent(double share) {
  const double percent = 100.0 * share;
  std::string number;
  if (percent == 0 || percent == 100) {
    number = fmt::format("{:.0f}", percent);
  } else if (percent > 99.5) {
    // A share that is not all or nothing does not look like all or nothing.
    number = fmt::format("{:.1f}", std::min(percent, 99.9));
  } else if (percent >= 10) {
    number = fmt::format("{:.0f}", percent);
  } else {
    number = Significant(std::max(percent, 0.001), percent < 1 ? 1 : 2);
  }
  return WithUnit(number, "%");
}

std::string Quoted(std::string_view name) { return fmt::format("“{}”", name); }

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
