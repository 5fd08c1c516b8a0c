#include "coordinator/report/sweep_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coordinator/report/plot.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/style.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kSweepLeft = 44, kSweepRight = 32, kSweepTop = 26, kSweepHeight = 280,
                 kSweepBottom = 44, kSweepLegend = 18;
// Dots of one value lie beside each other.
constexpr double kBetweenDots = 2.5;

struct Extent {
  double low = 1e300, high = -1e300;
  void Take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// A tick at each value that was tried.
void DrawValues(Svg* svg, const Frame& frame, const Axis& x, const SweepPlot& plot) {
  std::vector<std::pair<double, std::string>> values;
  for (const SweepSeries& series : plot.series) {
    for (const SweepPoint& point : series.points) values.emplace_back(point.value, point.label);
  }
  std::sort(values.begin(), values.end());
  svg->Line(frame.left, frame.bottom, frame.right, frame.bottom, "axis");
  double free_from = -1e9;
  for (const auto& [value, label] : values) {
    const double at = x.Pixel(value);
    svg->Line(at, frame.bottom, at, frame.bottom + 4, "axis");
    const double half = WidthOf(label) / 2;
    if (at - half < free_from) continue;
    svg->Text(at, frame.bottom + 16, Svg::Anchor::kMiddle, label, "tick");
    free_from = at + half + 6;
  }
  svg->Text(frame.right, frame.bottom + 34, Svg::Anchor::kEnd, plot.x_title, "tick");
}

void DrawSeries(Svg* svg, const Axis& x, const Axis& y, const SweepSeries& series) {
  Svg::Points median, band;
  for (const SweepPoint& point : series.points) {
    const Spread spread = SpreadOf(point.means);
    median.emplace_back(x.Pixel(point.value), y.Pixel(spread.median));
    band.emplace_back(x.Pixel(point.value), y.Pixel(spread.upper_quartile));
  }
  for (auto point = series.points.rbegin(); point != series.points.rend(); ++point) {
    band.emplace_back(x.Pixel(point->value), y.Pixel(SpreadOf(point->means).lower_quartile));
  }
  svg->Path(PathThrough(band) + "z", "band " + SeriesClass('f', series.colour));
  for (const SweepPoint& point : series.points) {
    const auto n = static_cast<double>(point.means.size());
    for (std::size_t i = 0; i < point.means.size(); ++i) {
      const double aside = (static_cast<double>(i) - (n - 1) / 2) * kBetweenDots;
      svg->Circle(x.Pixel(point.value) + aside, y.Pixel(point.means[i]), 2.5,
                  "dot " + SeriesClass('f', series.colour));
    }
  }
  svg->Polyline(median, "bold " + SeriesClass('s', series.colour));
}

}  // namespace

bool IsGeometric(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < 3 || values.front() <= 0) return false;
  // Steps that grow all along: 1, 2, 4, 8 or 20, 60, 180, but not 1, 2, 3.
  const double first = values[1] - values[0];
  const double last = values[values.size() - 1] - values[values.size() - 2];
  return values.back() / values.front() >= 4 && last > 1.5 * first;
}

Drawing DrawSweep(const SweepPlot& plot, int width) {
  Extent across, up;
  up.Take(0);
  std::vector<double> values;
  for (const double mark : plot.marks) up.Take(mark);
  for (const SweepSeries& series : plot.series) {
    for (const SweepPoint& point : series.points) {
      across.Take(point.value);
      values.push_back(point.value);
      for (const double mean : point.means) up.Take(mean);
    }
  }
  const double legend =
      plot.series.size() > 1 ? kSweepLegend * static_cast<double>(plot.series.size()) : 0;
  const Frame frame{kSweepLeft, kSweepTop + legend, width - kSweepRight,
                    kSweepTop + legend + kSweepHeight};
  const bool logarithmic = plot.is_numeric && IsGeometric(values);
  Axis x = logarithmic ? Axis::Logarithmic(across.low, across.high)
                       : Axis::Exact(across.low, across.high, 5);
  x.Place(frame.left, frame.right);
  // The axis goes only as far as there are values, with room for the dots.
  const double from = x.Pixel(across.low), to = x.Pixel(across.high);
  const double room = 24;
  if (to > from) {
    const double scale = (frame.right - frame.left - 2 * room) / (to - from);
    x.Place(frame.left + room - (from - frame.left) * scale,
            frame.left + room - (from - frame.left) * scale + (frame.right - frame.left) * scale);
  } else {
    x.Place((frame.left + frame.right) / 2, frame.right);
  }
  Axis y = Axis::Linear(0, up.high, 5);
  y.Place(frame.bottom, frame.top);
  Svg svg;
  svg.Text(6, 14, Svg::Anchor::kStart, plot.y_title, "tick");
  DrawVerticalAxis(&svg, frame, y);
  for (const double mark : plot.marks) {
    svg.Line(frame.left, y.Pixel(mark), frame.right, y.Pixel(mark), "mark");
    svg.Text(frame.right + 4, y.Pixel(mark) + 4, Svg::Anchor::kStart, PlainMetres(mark), "tick");
  }
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const SweepSeries& series = plot.series[i];
    DrawSeries(&svg, x, y, series);
    if (legend == 0) continue;
    const double line = kSweepTop + kSweepLegend * (static_cast<double>(i) + 0.5);
    svg.Line(frame.left, line - 4, frame.left + 18, line - 4,
             "bold " + SeriesClass('s', series.colour));
    svg.Text(frame.left + 24, line, Svg::Anchor::kStart, series.name,
             "name " + SeriesClass('t', series.colour));
  }
  DrawValues(&svg, frame, x, plot);
  return {width, static_cast<int>(frame.bottom + kSweepBottom), svg.Take()};
}

}  // namespace tcs::report
