// The systems at a glance, and the distance between the two bodies.
#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/histogram_figure.h"
#include "coordinator/report/html.h"
#include "coordinator/report/over_runs.h"
#include "coordinator/report/sections.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/text.h"
#include "coordinator/report/tracks_figure.h"

namespace tcs::report {

namespace {

std::vector<const System*> SystemsWithTracks(const Results& results) {
  std::vector<const System*> systems;
  for (const System& system : results.systems) {
    const bool any = std::any_of(system.runs.begin(), system.runs.end(),
                                 [](const Run& run) { return !run.track.time_s.empty(); });
    if (any) systems.push_back(&system);
  }
  return systems;
}

std::string BetweenBodies(const Results& results) {
  return fmt::format("{} and {}", results.bodies[0], results.bodies[1]);
}

std::string Metres(double value) { return Significant(value) + " m"; }

}  // namespace

Section SystemsSection(const Results& results, const std::vector<double>& marks) {
  std::vector<Column> columns{{"system", false}, {"trials"},     {"failed"}, {"samples"},
                              {"mean [m]"},      {"median [m]"}, {"SD [m]"}};
  for (const double mark : marks) columns.push_back({"below " + Metres(mark)});
  columns.push_back({"Δ (most)"});
  columns.push_back({"overhead"});
  Table table("Distances are those of all samples of all trials.", columns);
  for (const System& system : results.systems) {
    const std::vector<double> distances = Distances(system);
    const Spread spread = SpreadOf(distances);
    const bool any = spread.count > 0;
    std::vector<std::string> cells{system.name,
                                   fmt::format("{}", system.runs.size()),
                                   fmt::format("{}", system.failed.size()),
                                   Grouped(spread.count),
                                   any ? Significant(spread.mean) : "–",
                                   any ? Significant(spread.median) : "–",
                                   any ? Significant(spread.deviation) : "–"};
    for (const double mark : marks) {
      cells.push_back(any ? Percent(ShareBelow(distances, mark)) : "–");
    }
    cells.push_back(Seconds(MostOf(system, &Run::drift_ns)));
    cells.push_back(Percent(OverheadOf(system)));
    table.Row(cells);
  }
  std::vector<std::string> counts;
  for (const System& system : results.systems) {
    counts.push_back(fmt::format(
        "{} of {}", Count(static_cast<std::int64_t>(system.runs.size()), "trial"), system.name));
  }
  return {"The systems", fmt::format("This page is made of {}.", Listed(counts)), table.Html()};
}

std::optional<Figure> DistanceHistogram(const Results& results, const std::vector<double>& marks) {
  const auto systems = SystemsWithTracks(results);
  if (systems.empty()) return {};
  HistogramPlot plot{
      fmt::format("distance between {} [m]", BetweenBodies(results)), "m", marks, {}};
  std::vector<std::string> said;
  std::pair<double, std::string> nearest{1e300, ""}, furthest{-1e300, ""};
  for (const System* system : systems) {
    const std::vector<double> distances = Distances(*system);
    const Spread spread = SpreadOf(distances);
    std::string text = fmt::format("{}: median {}, standard deviation {}", system->name,
                                   Metres(spread.median), Metres(spread.deviation));
    for (const double mark : marks) {
      text += fmt::format(", {} of the samples below {}", Percent(ShareBelow(distances, mark)),
                          Metres(mark));
    }
    said.push_back(text);
    nearest = std::min(nearest, {spread.median, system->name});
    furthest = std::max(furthest, {spread.median, system->name});
    plot.panels.push_back(
        {system->name, static_cast<int>(system - results.systems.data()), distances});
  }
  std::string sentence = fmt::format("{}.", fmt::join(said, "; "));
  if (nearest.first < furthest.first) {
    sentence += fmt::format(" {} are nearest in {} and furthest apart in {}.",
                            BetweenBodies(results), nearest.second, furthest.second);
  }
  return MakeFigure("distances", fmt::format("How far apart {} are", BetweenBodies(results)),
                    sentence,
                    "Each panel has a vertical scale of its own; the triangle is the median.",
                    [&](int width) { return DrawHistograms(plot, width); });
}

std::optional<Figure> DistanceOverTime(const Results& results, const std::vector<double>& marks) {
  const auto systems = SystemsWithTracks(results);
  if (systems.empty()) return {};
  std::vector<std::string> said;
  for (const System* system : systems) {
    const Track median = MedianTrack(*system);
    if (median.time_s.empty()) continue;
    const std::size_t middle = median.time_s.size() / 2;
    said.push_back(fmt::format("in {} {} at {} and {} at {}", system->name,
                               Metres(median.distance_m[middle]), Seconds(median.time_s[middle]),
                               Metres(median.distance_m.back()), Seconds(median.time_s.back())));
  }
  return MakeFigure(
      "distance-over-time", "Distance over time",
      fmt::format("The median distance over the trials is {}.", fmt::join(said, "; ")),
      "A thin line per trial, their median in bold; all panels have one scale.",
      [&](int width) { return DrawTracks(systems, marks, width); });
}

}  // namespace tcs::report
