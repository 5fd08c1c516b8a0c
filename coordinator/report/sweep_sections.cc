// The effect of a value that was varied.
#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/over_runs.h"
#include "coordinator/report/sections.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/sweep_figure.h"
#include "coordinator/report/table.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

std::vector<double> MeansOf(const System& system) {
  std::vector<double> means;
  for (const Run& run : system.runs) {
    if (!run.track.distance_m.empty()) means.push_back(SpreadOf(run.track.distance_m).mean);
  }
  return means;
}

// A system's colour is its sweep's, too.
int ColourOf(const Results& results, const Sweep& sweep) {
  for (std::size_t i = 0; i < results.systems.size(); ++i) {
    if (results.systems[i].name == sweep.name) return static_cast<int>(i);
  }
  const auto place = static_cast<std::size_t>(&sweep - results.sweeps.data());
  return static_cast<int>(results.systems.size() + place);
}

std::vector<const Sweep*> SweepsOver(const Results& results, const std::string& key) {
  std::vector<const Sweep*> sweeps;
  for (const Sweep& sweep : results.sweeps) {
    if (sweep.key == key) sweeps.push_back(&sweep);
  }
  return sweeps;
}

bool AreNumbers(const std::vector<const Sweep*>& sweeps) {
  return std::all_of(sweeps.begin(), sweeps.end(), [](const Sweep* sweep) {
    return std::all_of(sweep->values.begin(), sweep->values.end(),
                       [](const SweepValue& value) { return value.number.has_value(); });
  });
}

SweepSeries SeriesOf(const Results& results, const Sweep& sweep, bool numeric,
                     std::vector<std::string>* places) {
  SweepSeries series{sweep.name, ColourOf(results, sweep), {}};
  for (const SweepValue& value : sweep.values) {
    std::vector<double> means = MeansOf(value.system);
    if (means.empty()) continue;
    auto place = std::find(places->begin(), places->end(), value.text);
    if (place == places->end()) place = places->insert(places->end(), value.text);
    const double at = numeric ? *value.number : static_cast<double>(place - places->begin());
    series.points.push_back({value.text, at, std::move(means)});
  }
  std::stable_sort(series.points.begin(), series.points.end(),
                   [](const SweepPoint& a, const SweepPoint& b) { return a.value < b.value; });
  return series;
}

std::string AboutSeries(const SweepSeries& series, const std::string& key,
                        const std::vector<double>& marks) {
  const auto median = [](const SweepPoint& point) { return SpreadOf(point.means).median; };
  const SweepPoint &first = series.points.front(), &last = series.points.back();
  std::string text =
      fmt::format("“{}”: {} at {} = {}", series.name, Metres(median(first)), key, first.label);
  if (series.points.size() > 1) {
    text += fmt::format(" and {} at {}", Metres(median(last)), last.label);
  }
  for (const double mark : marks) {
    const bool starts_below = median(first) < mark;
    const auto crossed = std::find_if(
        series.points.begin(), series.points.end(),
        [&](const SweepPoint& point) { return (median(point) < mark) != starts_below; });
    if (crossed == series.points.end()) {
      text += fmt::format(", {} {} throughout", starts_below ? "below" : "not below",
                          PlainMetres(mark));
    } else {
      text += fmt::format(", {} {} first at {}", starts_below ? "not below" : "below",
                          PlainMetres(mark), crossed->label);
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> VariedKeys(const Results& results) {
  std::vector<std::string> keys;
  for (const Sweep& sweep : results.sweeps) {
    if (std::find(keys.begin(), keys.end(), sweep.key) == keys.end()) keys.push_back(sweep.key);
  }
  return keys;
}

std::optional<Figure> SweepFigure(const Results& results, const std::string& key,
                                  const std::vector<double>& marks) {
  const std::vector<const Sweep*> sweeps = SweepsOver(results, key);
  const bool numeric = AreNumbers(sweeps);
  SweepPlot plot{key, "mean distance of a trial [m]", numeric, marks, {}};
  std::vector<std::string> said, places;
  for (const Sweep* sweep : sweeps) {
    SweepSeries series = SeriesOf(results, *sweep, numeric, &places);
    if (series.points.empty()) continue;
    said.push_back(AboutSeries(series, key, marks));
    plot.series.push_back(std::move(series));
  }
  if (plot.series.empty()) return {};
  return MakeFigure(
      "sweep-" + FileName(key),
      fmt::format("Distance between {} and {} against {}", results.bodies[0], results.bodies[1],
                  key),
      fmt::format("Median over the trials of the mean distance. {}.", fmt::join(said, "; ")),
      "A dot per trial; the line joins their medians, the band their quartiles.",
      [&](int width) { return DrawSweep(plot, width); });
}

Section SweepSection(const Results& results, const std::string& key,
                     const std::vector<double>& marks) {
  std::vector<Column> columns{{"system", false},    {key},         {"trials"},
                              {"failed"},           {"median"},    {"Δ"},
                              {"Δ / virtual time"}, {"staleness"}, {"overhead"}};
  for (const double mark : marks) {
    const auto place = columns.end() - 4;
    columns.insert(place, {"below " + PlainMetres(mark)});
  }
  Table table(fmt::format("Per value of {}; distances are those of all samples.", key), columns);
  std::vector<std::string> said;
  for (const Sweep* sweep : SweepsOver(results, key)) {
    double least = 1e300, most = 0;
    for (const SweepValue& value : sweep->values) {
      const System& system = value.system;
      const std::vector<double> distances = Distances(system);
      const double drift = MostOf(system, &Run::drift_ns);
      least = std::min(least, drift);
      most = std::max(most, drift);
      std::vector<std::string> cells{
          sweep->name,
          value.text,
          fmt::format("{}", system.runs.size()),
          fmt::format("{}", system.failed.size()),
          distances.empty() ? "–" : Metres(SpreadOf(distances).median),
          Seconds(drift),
          Significant(drift / std::max(1e-9, MeanOf(system, &Run::virtual_ns))),
          Seconds(MostOf(system, &Run::staleness_ns)),
          Percent(OverheadOf(system))};
      for (const double mark : marks) {
        cells.insert(cells.end() - 4,
                     distances.empty() ? "–" : Percent(ShareBelow(distances, mark)));
      }
      table.Row(cells);
    }
    said.push_back(least == most
                       ? fmt::format("{} at each value in {}", Seconds(most), sweep->name)
                       : fmt::format("{} to {} in {}", Seconds(least), Seconds(most), sweep->name));
  }
  return {fmt::format("Δ and overhead against {}", key), fmt::format("Δ was {}.", Listed(said)),
          table.Html(), table.Text()};
}

}  // namespace tcs::report
