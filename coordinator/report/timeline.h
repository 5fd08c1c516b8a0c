// The times at which the rows of one run ran, in virtual and in real time, made small enough for a
// page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

// Microseconds.
struct Slice {
  int row = 0;
  std::int64_t virtual_start = 0, virtual_end = 0;
  std::int64_t real_start = 0, real_end = 0;  // both 0 in runs without real times
  // How much of the slice the row ran: all of it, but for slices that were made of several.
  std::int64_t virtual_ran = 0, real_ran = 0;
};

// A deadline that was missed; virtual microseconds.
struct Miss {
  int row = 0;
  std::int64_t released_us = 0, due_us = 0, ended_us = 0;
  std::string sentence;                                      // empty for the later of very many
  std::vector<std::pair<std::string, std::string>> parts{};  // how long, and what with
};

struct Timeline {
  std::string name;               // the system's
  std::vector<std::string> rows;  // the dynamics, then clients
  bool has_real_times = false;
  std::vector<Slice> slices;  // in their order in real time, or in virtual time without
  std::int64_t virtual_end = 0, real_end = 0;
  std::vector<Miss> misses{};
  std::int64_t merged_us = 0;  // slices of a row that are closer than this are one
};

// The columns that are read of dispatches.csv. Deterministic runs have no real times.
extern const std::vector<std::string_view> kDispatchColumns;
inline constexpr std::size_t kDispatchColumnsWithoutReal = 3;

// The row that is no client's.
inline constexpr std::string_view kDynamicsRow = "dynamics";

// Makes a timeline of the lines of dispatches.csv, one after the other; rows in the order in which
// they come.
class TimelineBuilder {
 public:
  // `timeline` is filled, and outlives this.
  explicit TimelineBuilder(Timeline* timeline) : timeline_(*timeline) {}
  // Fields under the columns above. False: the line is of no use.
  bool Take(const CsvFields& fields);

 private:
  int RowOf(std::string_view name);

  Timeline& timeline_;
};

// Reads the timeline from a run's dispatches.csv. A client's threads share its row.
[[nodiscard]] LoadResult<Timeline> ReadTimeline(const std::string& folder, const std::string& name);

// Slices of a row become one where the gap between them is at most `gap_us` in each time. The time
// that each row ran stays the same.
[[nodiscard]] std::vector<Slice> Merged(const std::vector<Slice>& slices, std::int64_t gap_us);

// Merges slices that are closer and closer to each other until all timelines together have at most
// `most_slices`. Timelines with few slices keep all of them.
void Shorten(std::vector<Timeline>* timelines, std::size_t most_slices);

// The timeline as page/timeline.js reads it: an object of JSON, the slices in it as base64 of
// bytes.
[[nodiscard]] nlohmann::ordered_json ToJson(const Timeline& timeline);
[[nodiscard]] std::string Encoded(const Timeline& timeline);

}  // namespace tcs::report
