#include "coordinator/metrics/metric_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>

#include "coordinator/metrics/metric_sums.h"

namespace tcs {

namespace {

constexpr std::size_t kMostShown = 40;
// Programs go on for this long after the run's end, at most.
constexpr std::int64_t kGraceNs = 60'000'000'000;

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool IsDigitChar(char c) { return c >= '0' && c <= '9'; }

bool IsOfName(char c) {
  return IsDigitChar(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         c == '-' || c == '.' || c == '/';
}

// The next word; empty at the end.
std::string_view TakeWord(std::string_view* text) {
  while (!text->empty() && IsBlank(text->front())) text->remove_prefix(1);
  const auto end = std::find_if(text->begin(), text->end(), IsBlank);
  const std::string_view word = text->substr(0, static_cast<std::size_t>(end - text->begin()));
  text->remove_prefix(word.size());
  return word;
}

// The word as a sentence shows it to a person: its beginning, without characters that a terminal
// would obey.
std::string Shown(std::string_view word) {
  std::string shown(word.substr(0, kMostShown));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  }
  return word.size() > kMostShown ? shown + "..." : shown;
}

std::optional<double> ValueOf(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return {};
  // Too near to 0 to be another number.
  if (error == std::errc::result_out_of_range && word.find("e-") != std::string_view::npos) {
    return 0.0;
  }
  if (error != std::errc() || !IsMetricValue(value)) return {};
  return value;
}

struct TimeUnit {
  std::string_view name;
  int power_of_ten;  // nanoseconds in one of it
};
constexpr std::array kTimeUnits = {TimeUnit{"", 9}, TimeUnit{"s", 9}, TimeUnit{"ms", 6},
                                   TimeUnit{"us", 3}, TimeUnit{"ns", 0}};

constexpr std::size_t kDigitsOfNanoseconds = 12;

// Digits, perhaps with a point among them, and a unit; to the nearest nanosecond. Digit by digit,
// because a double does not hold the nanoseconds of a date.
std::optional<std::int64_t> TimeOf(std::string_view word) {
  std::size_t i = 0, digits = 0;
  int behind_point = 0;
  bool after_point = false;
  std::string whole;
  for (; i < word.size() && (IsDigitChar(word[i]) || (word[i] == '.' && !after_point)); ++i) {
    if (word[i] == '.') {
      after_point = true;
      continue;
    }
    ++digits;
    if (after_point) ++behind_point;
    whole += word[i];
  }
  const auto unit = std::ranges::find(kTimeUnits, word.substr(i), &TimeUnit::name);
  if (digits == 0 || unit == kTimeUnits.end()) return {};
  // A whole number without a unit that would be a date after the year 5000: nanoseconds, as
  // Python's time.time_ns and time.monotonic_ns have them.
  const bool is_whole_ns = !after_point && unit->name.empty() && digits >= kDigitsOfNanoseconds;
  const int power = is_whole_ns ? 0 : unit->power_of_ten - behind_point;
  bool rounds_up = false;
  if (power >= 0) {
    whole.append(static_cast<std::size_t>(power), '0');
  } else {
    const auto cut = static_cast<std::size_t>(-power);
    whole.insert(0, cut, '0');  // there may be fewer digits than that
    rounds_up = whole[whole.size() - cut] >= '5';
    whole.resize(whole.size() - cut);
  }
  std::int64_t ns = 0;
  const auto [end, error] = std::from_chars(whole.data(), whole.data() + whole.size(), ns);
  constexpr std::int64_t kMost = std::int64_t{1} << 62;
  if (error != std::errc() || ns > kMost) return {};
  return ns + (rounds_up ? 1 : 0);
}

}  // namespace

bool IsMetricLine(std::string_view line) {
  return line.starts_with(kMetricWord) &&
         (line.size() == kMetricWord.size() || IsBlank(line[kMetricWord.size()]));
}

std::variant<MetricLine, std::string> ParseMetricLine(std::string_view line) {
  if (line.size() > kLongestMetricLine) {
    return fmt::format("is longer than {} bytes", kLongestMetricLine);
  }
  line.remove_prefix(std::min(kMetricWord.size(), line.size()));
  const std::string_view name = TakeWord(&line), value = TakeWord(&line), time = TakeWord(&line);
  if (name.empty()) return "has no name and no value";
  if (name.size() > kLongestMetricName || !std::ranges::all_of(name, IsOfName)) {
    return fmt::format(
        "has the name '{}'; a name is of up to {} letters, digits, '_', '-', '.' and '/'",
        Shown(name), kLongestMetricName);
  }
  if (value.empty()) return fmt::format("has no value for {}", name);
  const std::optional<double> number = ValueOf(value);
  if (!number) {
    return fmt::format("has the value '{}', which is no finite number like 0.25", Shown(value));
  }
  MetricLine parsed{std::string(name), *number, {}};
  if (!time.empty()) {
    parsed.reading_ns = TimeOf(time);
    if (!parsed.reading_ns) {
      return fmt::format(
          "has the time '{}', which is no number of seconds, nor one with a unit like 12.5s, 40ms "
          "or 1000000ns",
          Shown(time));
    }
  }
  if (const std::string_view more = TakeWord(&line); !more.empty()) {
    return fmt::format("has '{}' behind its name, value and time", Shown(more));
  }
  return parsed;
}

std::optional<std::int64_t> VirtualTimeOfReading(std::int64_t reading_ns, std::int64_t written_ns,
                                                 const ProgramClocks& clocks) {
  std::optional<std::int64_t> nearest;
  for (const std::int64_t at_start_ns :
       {std::int64_t{0}, clocks.monotonic_ns, clocks.realtime_ns}) {
    if (reading_ns < at_start_ns || reading_ns - at_start_ns > clocks.duration_ns + kGraceNs)
      continue;
    const std::int64_t at_ns = std::min(reading_ns - at_start_ns, clocks.duration_ns);
    if (!nearest || std::abs(at_ns - written_ns) < std::abs(*nearest - written_ns)) nearest = at_ns;
  }
  return nearest;
}

}  // namespace tcs
