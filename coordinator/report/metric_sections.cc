#include "coordinator/report/metric_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "coordinator/report/metric_curves.h"
#include "coordinator/report/plot.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/style.h"
#include "coordinator/report/table.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr std::size_t kMostCurves = 12;
constexpr double kMetricsLeft = 64, kMetricsRight = 12, kMetricsTop = 6, kMetricsPanel = 90,
                 kMetricsName = 34, kMetricsBottom = 40;

struct CurvesOfSystem {
  const System* system;
  int colour;
  double end_s;
  std::map<std::string, MetricFigure> figures;
  std::map<std::string, MetricCurve> curves;
};

std::vector<CurvesOfSystem> CurvesOf(const Results& results) {
  std::vector<CurvesOfSystem> all;
  for (std::size_t i = 0; i < results.systems.size(); ++i) {
    const System& system = results.systems[i];
    if (system.runs.empty()) continue;
    const Run& run = system.runs.front();
    CurvesOfSystem of{&system,
                      static_cast<int>(i),
                      static_cast<double>(run.virtual_ns) * 1e-9,
                      ReadMetricFigures(run.folder),
                      {}};
    of.curves = ReadMetricCurves(run.folder, of.end_s, of.figures);
    all.push_back(std::move(of));
  }
  return all;
}

// The axis for the values of one metric, of all systems, so that these can be compared.
Axis AxisOf(const std::vector<CurvesOfSystem>& all, const std::string& name) {
  bool has_any = false;
  double least = 0, most = 0;
  for (const CurvesOfSystem& of : all) {
    const auto curve = of.curves.find(name);
    if (curve == of.curves.end()) continue;
    for (const auto& [time_s, value] : curve->second.points) {
      least = has_any ? std::min(least, value) : value;
      most = has_any ? std::max(most, value) : value;
      has_any = true;
    }
  }
  // A line that is level stands in the middle.
  const double room = most > least ? 0 : std::max(1e-9, std::abs(most) * 0.1);
  return Axis::Linear(least - room, most + room, 3);
}

Drawing DrawMetrics(const std::vector<CurvesOfSystem>& all, const std::vector<std::string>& names,
                    int width) {
  double end_s = 0;
  for (const CurvesOfSystem& of : all) end_s = std::max(end_s, of.end_s);
  const double right = width - kMetricsRight;
  Axis x = Axis::Exact(0, end_s, width < kWideWidth ? 5 : 10);
  x.Place(kMetricsLeft, right);
  Svg svg;
  const double pitch = kMetricsName + kMetricsPanel;
  const double bottom = kMetricsTop + pitch * static_cast<double>(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double top = kMetricsTop + pitch * static_cast<double>(i) + kMetricsName;
    const Frame frame{kMetricsLeft, top, right, top + kMetricsPanel};
    Axis y = AxisOf(all, names[i]);
    y.Place(frame.bottom, frame.top);
    DrawVerticalAxis(&svg, frame, y);
    svg.Text(frame.left, frame.top - 8, Svg::Anchor::kStart,
             Fitted(names[i], (right - kMetricsLeft) * 0.6), "name");
    for (const CurvesOfSystem& of : all) {
      const auto curve = of.curves.find(names[i]);
      if (curve == of.curves.end()) continue;
      Svg::Points points;
      for (const auto& [time_s, value] : curve->second.points) {
        points.emplace_back(x.Pixel(std::clamp(time_s, 0.0, end_s)), y.Pixel(value));
      }
      if (points.size() == 1) {
        svg.Circle(points[0].first, points[0].second, 2.5, SeriesClass('f', of.colour));
      } else {
        svg.Polyline(points, "line " + SeriesClass('s', of.colour));
      }
    }
    svg.Line(frame.left, frame.bottom, frame.right, frame.bottom, "axis");
  }
  // The names of the systems say which line is whose, beside the first name.
  double at = right;
  for (std::size_t i = all.size(); i-- > 0 && all.size() > 1;) {
    svg.Text(at, kMetricsTop + kMetricsName - 8, Svg::Anchor::kEnd, all[i].system->name,
             "tick " + SeriesClass('t', all[i].colour));
    at -= WidthOf(all[i].system->name) + 12;
  }
  DrawHorizontalAxis(&svg, {kMetricsLeft, kMetricsTop, right, bottom}, x, "virtual time [s]");
  return {width, static_cast<int>(bottom + kMetricsBottom), svg.Take()};
}

std::string Spelled(const std::string& figure) {
  return figure == "first_time_when" ? "first time [s]" : figure;
}

}  // namespace

std::optional<Figure> MetricsOverTime(const Results& results) {
  const std::vector<CurvesOfSystem> all = CurvesOf(results);
  std::set<std::string> found;
  for (const CurvesOfSystem& of : all) {
    for (const auto& [name, curve] : of.curves) found.insert(name);
  }
  if (found.empty()) return {};
  std::vector<std::string> names(found.begin(), found.end());
  const std::size_t left_out = names.size() - std::min(names.size(), kMostCurves);
  names.resize(names.size() - left_out);
  std::string sentence = fmt::format("How {} went over virtual time.", Listed(names));
  if (left_out > 0) {
    sentence += fmt::format(" {} are in metrics.csv alone.",
                            Count(static_cast<std::int64_t>(left_out), "further metric"));
  }
  return MakeFigure("metrics", "Metrics over time", sentence,
                    "A scale for each metric, in its own unit; of each system the first trial. "
                    "Where there are very many values, the least and the greatest of each moment.",
                    [&](int width) { return DrawMetrics(all, names, width); });
}

std::optional<Section> MetricsSection(const Results& results) {
  Table table(
      "Of each trial the figure that the scenario asks for; of what programs print, the "
      "mean of a trial's values.",
      {{"metric", false},
       {"from", false},
       {"system", false},
       {"figure", false},
       {"trials"},
       {"mean"},
       {"SD"},
       {"min"},
       {"max"}});
  std::set<std::string> names;
  for (const System& system : results.systems) {
    std::map<std::string, std::vector<double>> values;
    std::map<std::string, MetricFigure> last;
    for (const Run& run : system.runs) {
      for (auto& [name, figure] : ReadMetricFigures(run.folder)) {
        if (figure.value) values[name].push_back(*figure.value);
        last[name] = figure;
      }
    }
    for (const auto& [name, figure] : last) {
      names.insert(name);
      const std::vector<double>& of = values[name];
      const Spread spread = SpreadOf(of);
      const auto number = [&](double value) {
        return of.empty() ? "–" : fmt::format("{:.4g}", value);
      };
      table.Row({name, figure.from, system.name, Spelled(figure.asked),
                 fmt::format("{} of {}", of.size(), system.runs.size()), number(spread.mean),
                 of.size() > 1 ? number(spread.deviation) : "–", number(spread.least),
                 number(spread.most)});
    }
  }
  if (names.empty()) return {};
  return Section{
      "What the metrics came to",
      fmt::format("There are {}.", Count(static_cast<std::int64_t>(names.size()), "metric")),
      table.Html(), table.Text()};
}

}  // namespace tcs::report
