// Numbers and names as people read them, and as HTML, SVG and JSON hold them. Text is UTF-8;
// between a number and its unit is a space that does not break.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tcs::report {

// For HTML and XML, in text and in quoted attributes.
[[nodiscard]] std::string Escaped(std::string_view text);

// With so many significant digits, but never in powers of ten: "0.0935", "9.06", "168", "20010".
[[nodiscard]] std::string Significant(double value, int digits = 3);

// At most three significant digits, none of them a zero for show: "5", "0.667", "168".
[[nodiscard]] std::string Plain(double value);

// Groups of three from 10 000 on.
[[nodiscard]] std::string Grouped(std::int64_t value);

[[nodiscard]] std::string WithUnit(const std::string& number, std::string_view unit);

// "9.06 m", "5 m".
[[nodiscard]] std::string Metres(double value);
[[nodiscard]] std::string PlainMetres(double value);

// "0 s", "62 ns", "1.00 ms", "168 s".
[[nodiscard]] std::string Seconds(double seconds, int digits = 3);

// "9.1 %", "0.07 %", "100 %".
[[nodiscard]] std::string Percent(double share);

// A name that people gave, in the middle of a sentence: “out”.
[[nodiscard]] std::string Quoted(std::string_view name);

// "3 trials", "1 trial".
[[nodiscard]] std::string Count(std::int64_t number, std::string_view of_what);

// "a", "a and b", "a, b and c".
template <class Texts>
[[nodiscard]] std::string Listed(const Texts& texts) {
  std::string listed;
  std::size_t i = 0;
  for (const auto& text : texts) {
    if (i > 0) listed += i + 1 == texts.size() ? " and " : ", ";
    listed += text;
    ++i;
  }
  return listed;
}

// A file's name made of any text: letters, digits, '-', '_' and '.'.
[[nodiscard]] std::string FileName(std::string_view text);

}  // namespace tcs::report
