// A line of a program's output that tells a value: `tcs-metric NAME VALUE [TIME]`. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace tcs {

inline constexpr std::string_view kMetricWord = "tcs-metric";
// Of a name, and of such a line as a whole, in bytes.
inline constexpr std::size_t kLongestMetricName = 64, kLongestMetricLine = 512;

struct MetricLine {
  std::string name;  // of letters, digits, '_', '-', '.' and '/'
  double value = 0;  // IsMetricValue
  // The time that a clock of the program shows; none: the time of the write counts.
  std::optional<std::int64_t> reading_ns;
};

// Whether `line` is meant to be a metric line. It is without its line end.
[[nodiscard]] bool IsMetricLine(std::string_view line);

// Parses a line that is meant to be a metric line. The result is what the line says, or what is
// wrong with it, as a sentence without a subject: "has no value".
[[nodiscard]] std::variant<MetricLine, std::string> ParseMetricLine(std::string_view line);

// The times that the clocks of programs show at the run's start, and how long the run is to last at
// most.
struct ProgramClocks {
  std::int64_t monotonic_ns = 0, realtime_ns = 0;
  std::int64_t duration_ns = 0;
};

// The virtual time at which a clock of a program shows `reading_ns`: CLOCK_REALTIME,
// CLOCK_MONOTONIC, or the time since the run's start, as readings of sensors have it. Of the times
// within the run the one that is nearest to `written_ns`; none: there is no such time. A time that
// a program reads while it ends, soon after the run, counts as the run's end.
[[nodiscard]] std::optional<std::int64_t> VirtualTimeOfReading(std::int64_t reading_ns,
                                                               std::int64_t written_ns,
                                                               const ProgramClocks& clocks);

}  // namespace tcs
