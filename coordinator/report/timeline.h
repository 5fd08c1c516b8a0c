// Who ran when in one run, in virtual and in real time, made small enough for a page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/scenario/load_error.h"

namespace tcs::report {

// Microseconds.
struct Slice {
  int row = 0;
  std::int64_t virtual_start = 0, virtual_end = 0;
  std::int64_t real_start = 0, real_end = 0;  // both 0 in runs without real times
  // How much of that the row ran: all, but for slices that were made of several.
  std::int64_t virtual_ran = 0, real_ran = 0;
};

struct Timeline {
  std::string name;               // the system's
  std::vector<std::string> rows;  // the dynamics, then clients
  bool has_real_times = false;
  std::vector<Slice> slices;  // in their order in real time, or in virtual time without
  std::int64_t virtual_end = 0, real_end = 0;
  std::int64_t merged_us = 0;  // slices of a row that are closer than this are one
};

// From a run's dispatches.csv. A client's threads share its row.
[[nodiscard]] LoadResult<Timeline> ReadTimeline(const std::string& folder, const std::string& name);

// Slices of a row become one where the gap between them is at most `gap_us` in each time. What each
// row ran stays the same.
[[nodiscard]] std::vector<Slice> Merged(const std::vector<Slice>& slices, std::int64_t gap_us);

// Merges slices that are closer and closer to each other until all timelines together have at most
// `most_slices`. Those with few keep all of theirs.
void Shorten(std::vector<Timeline>* timelines, std::size_t most_slices);

// As page/timeline.js reads it: an object of JSON, the slices in it as base64 of bytes.
[[nodiscard]] std::string Encoded(const Timeline& timeline);

}  // namespace tcs::report
