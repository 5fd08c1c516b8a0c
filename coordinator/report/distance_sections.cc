// The systems at a glance, and the distance between the two bodies.
#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/histogram_figure.h"
#include "coordinator/report/over_runs.h"
#include "coordinator/report/sections.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/table.h"
#include "coordinator/report/text.h"
#include "coordinator/report/tracks_figure.h"

namespace tcs::report {

namespace {

// The panels of the systems that have any distance.
std::vector<TracksPanel> PanelsOf(const Results& results) {
  std::vector<TracksPanel> panels;
  for (std::size_t i = 0; i < results.systems.size(); ++i) {
    const System& system = results.systems[i];
    const bool any = std::any_of(system.runs.begin(), system.runs.end(),
                                 [](const Run& run) { return !run.track.time_s.empty(); });
    if (any) panels.push_back({&system, static_cast<int>(i)});
  }
  return panels;
}

std::string BetweenBodies(const Results& results) {
  return fmt::format("{} and {}", results.bodies[0], results.bodies[1]);
}

}  // namespace

std::optional<Section> SystemsSection(const Results& results, const std::vector<double>& marks) {
  const bool has_bodies = !results.bodies[0].empty();
  const bool has_trials = std::ranges::any_of(results.systems, [](const System& system) {
    return system.runs.size() + system.failed.size() > 1;
  });
  if (results.systems.empty() || (results.systems.size() == 1 && !has_bodies && !has_trials))
    return {};
  std::vector<Column> columns{{"system", false}, {"trials"}, {"failed"}};
  if (has_bodies) columns.insert(columns.end(), {{"samples"}, {"mean"}, {"median"}, {"SD"}});
  for (const double mark : marks) {
    if (has_bodies) columns.push_back({"below " + PlainMetres(mark)});
  }
  Table table(has_bodies ? fmt::format("The distance between {}, over all samples of all trials.",
                                       BetweenBodies(results))
                         : "Trials that failed are left out of all figures.",
              columns);
  std::vector<std::string> counts;
  for (const System& system : results.systems) {
    const auto trials = static_cast<std::int64_t>(system.runs.size());
    std::vector<std::string> cells{system.name, fmt::format("{}", trials),
                                   fmt::format("{}", system.failed.size())};
    if (has_bodies) {
      const std::vector<double> distances = Distances(system);
      const Spread spread = SpreadOf(distances);
      const bool any = spread.count > 0;
      const auto metres = [any](double value) { return any ? Metres(value) : "–"; };
      cells.insert(cells.end(), {Grouped(spread.count), metres(spread.mean), metres(spread.median),
                                 metres(spread.deviation)});
      for (const double mark : marks)
        cells.push_back(any ? Percent(ShareBelow(distances, mark)) : "–");
    }
    table.Row(cells);
    counts.push_back(fmt::format("{} of {} ({}{})", Count(trials, "trial"), Quoted(system.name),
                                 Seconds(MeanOf(system, &Run::virtual_ns)),
                                 trials > 1 ? " each" : ""));
  }
  return Section{"The systems", fmt::format("This page is made of {}.", Listed(counts)),
                 table.Html(), table.Text()};
}

std::optional<Figure> DistanceHistogram(const Results& results, const std::vector<double>& marks) {
  HistogramPlot plot{
      fmt::format("distance between {} [m]", BetweenBodies(results)), "m", "sample", marks, {}};
  std::vector<std::string> medians, below;
  for (const TracksPanel& panel : PanelsOf(results)) {
    const std::string& name = panel.system->name;
    std::vector<double> distances = Distances(*panel.system);
    const std::string in = InSystem(results, *panel.system);
    medians.push_back(Metres(SpreadOf(distances).median) + in);
    if (!marks.empty()) below.push_back(Percent(ShareBelow(distances, marks[0])) + in);
    plot.panels.push_back({name, panel.colour, std::move(distances)});
  }
  if (plot.panels.empty()) return {};
  std::string sentence = fmt::format("The median distance is {}.", Listed(medians));
  if (!marks.empty()) {
    sentence += fmt::format(" The share of the samples below {} is {}.", PlainMetres(marks[0]),
                            Listed(below));
  }
  return MakeFigure("distances", fmt::format("How far apart {} are", BetweenBodies(results)),
                    sentence,
                    "Each panel has a vertical scale of its own; the triangle is the median.",
                    [&](int width) { return DrawHistograms(plot, width); });
}

std::optional<Figure> DistanceOverTime(const Results& results, const std::vector<double>& marks) {
  const std::vector<TracksPanel> panels = PanelsOf(results);
  if (panels.empty()) return {};
  std::vector<std::string> said;
  for (const TracksPanel& panel : panels) {
    const Track median = MedianTrack(*panel.system);
    if (median.time_s.empty()) continue;
    const std::size_t middle = median.time_s.size() / 2;
    said.push_back(fmt::format("{} at {} and {} at {}{}", Metres(median.distance_m[middle]),
                               Seconds(median.time_s[middle]), Metres(median.distance_m.back()),
                               Seconds(median.time_s.back()), InSystem(results, *panel.system)));
  }
  return MakeFigure(
      "distance-over-time", "Distance over time",
      fmt::format("The median distance over the trials is {}.", fmt::join(said, "; ")),
      "A thin line per trial, their median in bold; all panels have one scale.",
      [&](int width) { return DrawTracks(panels, marks, width); });
}

}  // namespace tcs::report
