// The costs of keeping time together: Δ, staleness, and who had the processor.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "coordinator/report/over_runs.h"
#include "coordinator/report/paper_values.h"
#include "coordinator/report/sections.h"
#include "coordinator/report/table.h"
#include "coordinator/report/text.h"
#include "coordinator/report/timeline_figure.h"

namespace tcs::report {

namespace {

// All times are in one unit, to be compared.
std::string InSeconds(double seconds) { return WithUnit(fmt::format("{:.2f}", seconds), "s"); }

void AddPaper(Table* table) {
  for (const paper::Values& of : paper::kSystems) {
    std::vector<std::string> cells;
    for (const std::string_view cell :
         {of.system, of.virtual_time, std::string_view(), of.drift, std::string_view(),
          of.coordinating, of.clients, of.dynamics, of.overhead}) {
      cells.emplace_back(cell.empty() ? "–" : cell);
    }
    table->Row(cells, true);
  }
}

constexpr std::size_t kMostShares = 8;

// The share of the timeline that each row ran; of many rows the shares of those that ran most.
std::string Shares(const Timeline& timeline) {
  std::vector<std::int64_t> ran(timeline.rows.size());
  for (const Slice& slice : timeline.slices)
    ran[static_cast<std::size_t>(slice.row)] += slice.virtual_ran;
  const std::int64_t whole = timeline.virtual_end;
  std::vector<std::size_t> rows(timeline.rows.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  // The dynamics take all of virtual time.
  std::erase_if(rows, [&](std::size_t row) { return timeline.rows[row] == kDynamicsRow; });
  const std::size_t all = rows.size();
  const bool are_many = rows.size() > kMostShares;
  if (are_many) {
    std::stable_sort(rows.begin(), rows.end(),
                     [&](std::size_t a, std::size_t b) { return ran[a] > ran[b]; });
    rows.resize(kMostShares - 1);
  }
  std::vector<std::string> shares;
  for (const std::size_t row : rows) {
    const double share =
        whole > 0 ? static_cast<double>(ran[row]) / static_cast<double>(whole) : 0.0;
    shares.push_back(fmt::format("{} {}", timeline.rows[row], Percent(share)));
  }
  if (are_many) shares.push_back(fmt::format("{} others less", all - rows.size()));
  return Listed(shares);
}

// `is_only`: there is no other timeline to tell this one from.
std::string AboutTimeline(const Timeline& timeline, bool is_only) {
  const std::string of = is_only ? "" : Quoted(timeline.name) + ": ";
  const double virtual_s = static_cast<double>(timeline.virtual_end) * 1e-6;
  std::string misses;
  if (!timeline.misses.empty()) {
    misses =
        fmt::format(" {} missed.",
                    timeline.misses.size() == 1
                        ? std::string("One deadline was")
                        : fmt::format("{} deadlines were",
                                      Grouped(static_cast<std::int64_t>(timeline.misses.size()))));
  }
  return fmt::format("{}In {} of virtual time: {}.{}", of, Seconds(virtual_s), Shares(timeline),
                     misses);
}

}  // namespace

std::optional<Section> CostsSection(const Results& results) {
  const bool any = std::ranges::any_of(results.systems, [](const System& system) {
    return !system.runs.empty() && system.runs.front().has_summary;
  });
  if (!any) return {};
  Table table("Means over the trials; of Δ and staleness the most.", {{"system", false},
                                                                      {"virtual time"},
                                                                      {"real time"},
                                                                      {"Δ"},
                                                                      {"staleness"},
                                                                      {"coordinating"},
                                                                      {"clients"},
                                                                      {"dynamics"},
                                                                      {"overhead"}});
  std::vector<std::string> drifts;
  for (const System& system : results.systems) {
    table.Row({system.name, Seconds(MeanOf(system, &Run::virtual_ns)),
               Seconds(MeanOf(system, &Run::real_ns)), Seconds(MostOf(system, &Run::drift_ns)),
               Seconds(MostOf(system, &Run::staleness_ns)),
               InSeconds(MeanOf(system, &Run::coordinating_ns)),
               InSeconds(MeanOf(system, &Run::clients_ns)),
               InSeconds(MeanOf(system, &Run::dynamics_ns)), Percent(OverheadOf(system))});
    const double drift = MostOf(system, &Run::drift_ns);
    const double ratio = drift / std::max(1e-9, MeanOf(system, &Run::virtual_ns));
    std::string text = Seconds(drift) + InSystem(results, system);
    if (ratio >= 1) text += fmt::format(" ({} times its virtual time)", Significant(ratio));
    drifts.push_back(std::move(text));
  }
  std::string explained =
      "Δ is how far the progress of two parts of the simulation ever came apart; staleness, how "
      "much "
      "older than the moment of a read the data was that it was given.";
  if (results.scenario.starts_with(paper::kScenario)) {
    AddPaper(&table);
    explained += " The rows below ours are the paper's own numbers, from its machine.";
  }
  return Section{"Δ, staleness and overhead",
                 fmt::format("Progress came apart by up to {}. {}", Listed(drifts), explained),
                 table.Html(), table.Text()};
}

std::optional<Figure> TimelineFigure(const std::vector<Timeline>& timelines) {
  if (timelines.empty()) return {};
  std::vector<std::string> said;
  std::int64_t merged_us = 0;
  for (const Timeline& timeline : timelines) {
    said.push_back(AboutTimeline(timeline, timelines.size() == 1));
    merged_us = std::max(merged_us, timeline.merged_us);
  }
  std::string note =
      "The first trial of each system. A bar's height is the share of the time that the row ran, "
      "the "
      "number beside it the share of the whole. A red line marks a deadline that was missed.";
  if (merged_us > 0) {
    note += fmt::format(" Slices of a row that are up to {} apart are drawn as one.",
                        Seconds(static_cast<double>(merged_us) * 1e-6, 2));
  }
  return MakeFigure("timeline", "Who ran when", fmt::format("{}", fmt::join(said, " ")), note,
                    [&](int width) { return DrawTimelines(timelines, width); });
}

}  // namespace tcs::report
