#include "coordinator/report/histogram_figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/statistics.h"
#include "coordinator/report/style.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kLeft = 44, kRight = 12, kTop = 20, kPanel = 88, kName = 34, kBottom = 40;
constexpr double kBins = 100;

std::string Legend(const HistogramPanel& panel, const Spread& spread, const std::string& unit,
                   const std::string& what, double pixels) {
  const std::string samples = Count(spread.count, what);
  const std::string all = fmt::format(
      "median {0} {1}, quartiles {2} and {3} {1}, {4}", Significant(spread.median), unit,
      Significant(spread.lower_quartile), Significant(spread.upper_quartile), samples);
  const double left = pixels - WidthOf(panel.name) - 20;
  if (WidthOf(all) <= left) return all;
  return Fitted(fmt::format("median {} {}", Significant(spread.median), unit), left);
}

void DrawPanel(Svg* svg, const Frame& frame, const Axis& x, const HistogramPlot& plot,
               const HistogramPanel& panel, double bin_width) {
  const Spread spread = SpreadOf(panel.values);
  svg->Text(frame.left, frame.top - 8, Svg::Anchor::kStart, panel.name,
            "name " + SeriesClass('t', panel.colour));
  if (spread.count == 0) {
    svg->Text(frame.right, frame.top - 8, Svg::Anchor::kEnd, "no values", "note");
    return;
  }
  svg->Text(frame.right, frame.top - 8, Svg::Anchor::kEnd,
            Legend(panel, spread, plot.unit, plot.what, frame.right - frame.left), "note");
  DrawHistogram(svg, frame, x, panel.values, bin_width, panel.colour);
  const double at = x.Pixel(spread.median);
  svg->Path(fmt::format("M{} {}l-4.5 8h9z", Coordinate(at), Coordinate(frame.bottom)),
            SeriesClass('f', panel.colour));
  svg->Line(frame.left, frame.bottom, frame.right, frame.bottom, "axis");
}

}  // namespace

void DrawHistogram(Svg* svg, const Frame& frame, const Axis& x, const std::vector<double>& values,
                   double bin_width, int colour) {
  const Histogram histogram = HistogramOf(values, x.low(), x.high(), bin_width);
  double most = 0;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    most = std::max(most, 100 * histogram.ShareOf(i));
  }
  Axis y = Axis::Linear(0, most, 2);
  y.Place(frame.bottom, frame.top);
  DrawVerticalAxis(svg, frame, y);
  Svg::Points outline;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const double from = histogram.low + static_cast<double>(i) * bin_width;
    const double height = y.Pixel(100 * histogram.ShareOf(i));
    outline.emplace_back(x.Pixel(from), height);
    outline.emplace_back(std::min(x.Pixel(from + bin_width), frame.right), height);
  }
  svg->Area(outline, frame.bottom, "fill " + SeriesClass('f', colour));
  svg->Polyline(outline, "line " + SeriesClass('s', colour));
}

Drawing DrawHistograms(const HistogramPlot& plot, int width) {
  double low = 0, high = 0;
  for (const HistogramPanel& panel : plot.panels) {
    for (const double value : panel.values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  for (const double mark : plot.marks) high = std::max(high, mark);
  const double right = width - kRight;
  // The values are shares of a whole, of one scale for all panels only along x.
  Axis x = Axis::Linear(low, high > low ? high : low + 1, width < kWideWidth ? 5 : 10);
  x.Place(kLeft, right);
  const double bin_width = NiceStep((x.high() - x.low()) / kBins);
  Svg svg;
  const double pitch = kName + kPanel;
  const double bottom = kTop + pitch * static_cast<double>(plot.panels.size());
  const Frame whole{kLeft, kTop, right, bottom};
  for (const double mark : plot.marks) {
    DrawMark(&svg, whole, x.Pixel(mark), WithUnit(Plain(mark), plot.unit));
  }
  for (std::size_t i = 0; i < plot.panels.size(); ++i) {
    const double top = kTop + pitch * static_cast<double>(i) + kName;
    DrawPanel(&svg, {kLeft, top, right, top + kPanel}, x, plot, plot.panels[i], bin_width);
  }
  DrawHorizontalAxis(&svg, whole, x, plot.x_title);
  svg.Text(6, kTop - 5, Svg::Anchor::kStart, fmt::format("% of {}s", plot.what), "tick");
  return {width, static_cast<int>(bottom + kBottom), svg.Take()};
}

}  // namespace tcs::report
