#include "coordinator/expect/junit.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace tcs {

namespace {

// The length in bytes of the well-formed character of UTF-8 at the beginning; 0: there is none.
std::size_t CharacterLength(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xc2 && first < 0xe0 ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  if (first == 0xe0 && byte(1) < 0xa0) return 0;
  if (first == 0xed && byte(1) >= 0xa0) return 0;
  if (first == 0xef && byte(1) == 0xbf && byte(2) >= 0xbe) return 0;  // XML has not U+FFFE, U+FFFF
  if (first == 0xf0 && byte(1) < 0x90) return 0;
  if (first == 0xf4 && byte(1) >= 0x90) return 0;
  return length;
}

std::string Escaped(std::string_view text) {
  std::string escaped;
  while (!text.empty()) {
    const std::size_t length = CharacterLength(text);
    const char c = text.front();
    if (length == 0 || (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t')) {
      escaped += '?';
    } else if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else if (c == '\n') {
      escaped += "&#10;";
    } else {
      escaped += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return escaped;
}

std::size_t FailuresOf(const JunitSuite& suite) {
  return static_cast<std::size_t>(std::ranges::count_if(
      suite.cases, [](const JunitCase& one) { return !one.failure.empty(); }));
}

}  // namespace

std::string JunitText(const std::vector<JunitSuite>& suites) {
  std::size_t tests = 0, failures = 0;
  for (const JunitSuite& suite : suites) {
    tests += suite.cases.size();
    failures += FailuresOf(suite);
  }
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuites name=\"tcsim\" tests=\"{}\" failures=\"{}\" errors=\"0\">\n",
      tests, failures);
  for (const JunitSuite& suite : suites) {
    text += fmt::format(
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\" "
        "time=\"{:.3f}\">\n",
        Escaped(suite.name), suite.cases.size(), FailuresOf(suite), suite.seconds);
    for (const JunitCase& one : suite.cases) {
      text += fmt::format("    <testcase classname=\"{}\" name=\"{}\"", Escaped(one.class_name),
                          Escaped(one.name));
      if (one.failure.empty()) {
        text += "/>\n";
        continue;
      }
      text += fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n",
                          Escaped(one.failure), Escaped(one.details));
    }
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

std::vector<JunitCase> JunitCases(const std::vector<Judgement>& judgements) {
  std::vector<JunitCase> cases;
  for (const Judgement& judgement : judgements) {
    cases.push_back({judgement.expected.subject,
                     judgement.expected.figure + " " + BoundText(judgement.expected),
                     judgement.holds ? "" : judgement.expected.subject + ": " + judgement.what,
                     SentenceOf(judgement)});
  }
  return cases;
}

}  // namespace tcs
