#include "coordinator/report/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "coordinator/report/bytes.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

namespace {

std::int64_t Microseconds(std::int64_t ns) { return (ns + 500) / 1000; }

// "predator/planner #7" is a thread of "predator/planner".
std::string_view ClientOf(std::string_view row) { return row.substr(0, row.find(" #")); }

}  // namespace

bool TimelineBuilder::Take(const CsvFields& fields) {
  std::int64_t times[4] = {0, 0, 0, 0};
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const auto ns = ToInteger(fields[i]);
    if (!ns || *ns < 0) return false;
    times[i - 1] = *ns;
  }
  if (times[1] < times[0] || times[3] < times[2]) return false;
  for (std::int64_t& time : times) time = Microseconds(time);
  timeline_.slices.push_back({RowOf(ClientOf(fields[0])), times[0], times[1], times[2], times[3],
                              times[1] - times[0], times[3] - times[2]});
  timeline_.virtual_end = std::max(timeline_.virtual_end, times[1]);
  timeline_.real_end = std::max(timeline_.real_end, times[3]);
  timeline_.has_real_times = fields.size() == kDispatchColumns.size();
  return true;
}

int TimelineBuilder::RowOf(std::string_view name) {
  auto& rows = timeline_.rows;
  const auto place = std::find(rows.begin(), rows.end(), name) - rows.begin();
  if (place == static_cast<std::ptrdiff_t>(rows.size())) rows.emplace_back(name);
  return static_cast<int>(place);
}

const std::vector<std::string_view> kDispatchColumns{"row", "virtual_start_ns", "virtual_end_ns",
                                                     "real_start_ns", "real_end_ns"};

namespace {

// The dynamics first, the rest by name.
void SortRows(Timeline* timeline) {
  std::vector<std::string> sorted = timeline->rows;
  std::sort(sorted.begin(), sorted.end(), [](const std::string& a, const std::string& b) {
    return std::make_tuple(a != "dynamics", a) < std::make_tuple(b != "dynamics", b);
  });
  std::vector<int> place(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto at = std::find(sorted.begin(), sorted.end(), timeline->rows[i]);
    place[i] = static_cast<int>(at - sorted.begin());
  }
  for (Slice& slice : timeline->slices) slice.row = place[static_cast<std::size_t>(slice.row)];
  timeline->rows = std::move(sorted);
}

void SortSlices(std::vector<Slice>* slices) {
  std::stable_sort(slices->begin(), slices->end(), [](const Slice& a, const Slice& b) {
    return std::tie(a.real_start, a.virtual_start) < std::tie(b.real_start, b.virtual_start);
  });
}

}  // namespace

std::vector<Slice> Merged(const std::vector<Slice>& slices, std::int64_t gap_us) {
  std::vector<Slice> merged;
  std::vector<std::size_t> last;  // of each row, its place in `merged` plus 1; 0: no slice yet
  for (const Slice& slice : slices) {
    const auto row = static_cast<std::size_t>(slice.row);
    if (last.size() <= row) last.resize(row + 1);
    if (last[row] != 0) {
      Slice& before = merged[last[row] - 1];
      if (slice.virtual_start - before.virtual_end <= gap_us &&
          slice.real_start - before.real_end <= gap_us) {
        before.virtual_end = std::max(before.virtual_end, slice.virtual_end);
        before.real_end = std::max(before.real_end, slice.real_end);
        before.virtual_ran += slice.virtual_ran;
        before.real_ran += slice.real_ran;
        continue;
      }
    }
    merged.push_back(slice);
    last[row] = merged.size();
  }
  return merged;
}

LoadResult<Timeline> ReadTimeline(const std::string& folder, const std::string& name) {
  Timeline timeline;
  timeline.name = name;
  TimelineBuilder builder(&timeline);
  const auto take = [&](const CsvFields& fields) { return builder.Take(fields); };
  const std::string path = folder + "/dispatches.csv";
  // Deterministic runs have no real times.
  std::vector<std::string_view> columns = kDispatchColumns;
  auto read = ReadCsv(path, columns, take);
  timeline.has_real_times = std::holds_alternative<std::int64_t>(read);
  if (!timeline.has_real_times) {
    columns.resize(kDispatchColumnsWithoutReal);
    read = ReadCsv(path, columns, take);
  }
  if (const auto* error = std::get_if<LoadError>(&read)) return *error;
  if (timeline.slices.empty()) return LoadError{path + " has no dispatches"};
  SortRows(&timeline);
  SortSlices(&timeline.slices);
  return timeline;
}

void Shorten(std::vector<Timeline>* timelines, std::size_t most_slices) {
  const auto total = [timelines] {
    std::size_t slices = 0;
    for (const Timeline& timeline : *timelines) slices += timeline.slices.size();
    return slices;
  };
  while (!timelines->empty() && total() > most_slices) {
    Timeline& longest = *std::max_element(
        timelines->begin(), timelines->end(),
        [](const Timeline& a, const Timeline& b) { return a.slices.size() < b.slices.size(); });
    longest.merged_us = std::max<std::int64_t>(20, 2 * longest.merged_us);
    longest.slices = Merged(longest.slices, longest.merged_us);
    SortSlices(&longest.slices);
    // Nothing is left to merge: each row is one slice.
    if (longest.slices.size() <= longest.rows.size()) return;
  }
}

nlohmann::ordered_json ToJson(const Timeline& timeline) {
  std::string bytes;
  std::int64_t virtual_end = 0, real_start = 0;
  const bool merged = timeline.merged_us > 0;
  for (const Slice& slice : timeline.slices) {
    PutNumber(&bytes, static_cast<std::uint64_t>(slice.row));
    PutSigned(&bytes, slice.virtual_start - virtual_end);
    PutNumber(&bytes, static_cast<std::uint64_t>(slice.virtual_end - slice.virtual_start));
    virtual_end = slice.virtual_end;
    if (merged) PutNumber(&bytes, static_cast<std::uint64_t>(slice.virtual_ran));
    if (!timeline.has_real_times) continue;
    PutNumber(&bytes, static_cast<std::uint64_t>(slice.real_start - real_start));
    PutNumber(&bytes, static_cast<std::uint64_t>(slice.real_end - slice.real_start));
    real_start = slice.real_start;
    if (merged) PutNumber(&bytes, static_cast<std::uint64_t>(slice.real_ran));
  }
  // Many parts are of the same thing, whose name is written once.
  auto whats = nlohmann::ordered_json::array(), misses = nlohmann::ordered_json::array();
  std::map<std::string, std::size_t> known;
  for (const Miss& miss : timeline.misses) {
    auto parts = nlohmann::ordered_json::array();
    for (const auto& [time, what] : miss.parts) {
      const auto [found, is_new] = known.try_emplace(what, known.size());
      if (is_new) whats.push_back(what);
      parts.push_back(nlohmann::ordered_json::array({time, found->second}));
    }
    misses.push_back(nlohmann::ordered_json::array(
        {miss.row, miss.released_us, miss.due_us, miss.ended_us, miss.sentence, std::move(parts)}));
  }
  return {{"name", timeline.name},
          {"misses", std::move(misses)},
          {"whats", std::move(whats)},
          {"rows", timeline.rows},
          {"real", timeline.has_real_times},
          {"merged", merged},
          {"virtualEnd", timeline.virtual_end},
          {"realEnd", timeline.real_end},
          {"count", timeline.slices.size()},
          {"slices", Base64(bytes)}};
}

std::string Encoded(const Timeline& timeline) { return ForScript(ToJson(timeline)); }

}  // namespace tcs::report
