#include "coordinator/report/response_figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/histogram_figure.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/style.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kResponseLeft = 44, kResponseRight = 12, kResponseTop = 20, kResponseName = 40,
                 kResponsePanel = 76, kResponseAxis = 48;
constexpr double kResponseBins = 120;

struct Scale {
  double of_second = 1;
  const char* unit = "s";
};

Scale ScaleOf(double most_s) {
  if (most_s < 1e-4) return {1e6, "µs"};
  if (most_s < 1) return {1e3, "ms"};
  return {1, "s"};
}

std::string LegendOf(const ResponseRow& row, double pixels) {
  std::vector<double> sorted = row.values_s;
  std::ranges::sort(sorted);
  const auto count = static_cast<std::int64_t>(sorted.size());
  const auto late = sorted.end() - std::ranges::upper_bound(sorted, row.deadline_s);
  const std::string times =
      fmt::format("median {}, 99 % within {}, longest {}", Seconds(Quantile(sorted, 0.5)),
                  Seconds(Quantile(sorted, 0.99)), Seconds(sorted.back()));
  const std::string misses = row.deadline_s > 0
                                 ? fmt::format("{} of {} late", Grouped(late), Grouped(count))
                                 : "no deadline";
  const std::string all = misses + "; " + times;
  return WidthOf(all) <= pixels ? all : Fitted(misses, pixels);
}

// The longest of the group's response times and deadlines.
double LongestOf(const ResponseGroup& group) {
  double most_s = 0;
  for (const ResponseRow& row : group.rows)
    most_s = std::max({most_s, row.deadline_s, *std::ranges::max_element(row.values_s)});
  return most_s;
}

void DrawRow(Svg* svg, const Frame& frame, const Axis& x, const Scale& scale,
             const ResponseRow& row) {
  std::vector<double> values = row.values_s;
  for (double& value : values) value *= scale.of_second;
  const double bin_width = NiceStep((x.high() - x.low()) / kResponseBins);
  DrawHistogram(svg, frame, x, values, bin_width, row.colour);
  if (row.deadline_s <= 0) return;
  const double at = x.Pixel(row.deadline_s * scale.of_second);
  svg->Line(at, frame.top - 4, at, frame.bottom, "deadline");
  // The label stands beside its line, where there is room.
  const std::string label = "deadline " + Seconds(row.deadline_s);
  const bool fits = at + 5 + WidthOf(label) <= frame.right;
  svg->Text(fits ? at + 5 : at - 5, frame.top + 8, fits ? Svg::Anchor::kStart : Svg::Anchor::kEnd,
            label, "tick");
}

}  // namespace

Drawing DrawResponses(const std::vector<ResponseGroup>& groups, int width) {
  Svg svg;
  const double right = width - kResponseRight;
  double top = kResponseTop;
  for (const ResponseGroup& group : groups) {
    const double most_s = LongestOf(group);
    const Scale scale = ScaleOf(most_s);
    Axis x = Axis::Linear(0, most_s > 0 ? most_s * scale.of_second : 1, width < kWideWidth ? 4 : 8);
    x.Place(kResponseLeft, right);
    Frame frame;
    for (const ResponseRow& row : group.rows) {
      top += kResponseName;
      frame = {kResponseLeft, top, right, top + kResponsePanel};
      const std::string name = row.system.empty() ? group.client : group.client + ", " + row.system;
      svg.Text(frame.left, frame.top - 26, Svg::Anchor::kStart, Fitted(name, right - kResponseLeft),
               "name " + SeriesClass('t', row.colour));
      svg.Text(frame.left, frame.top - 11, Svg::Anchor::kStart,
               LegendOf(row, right - kResponseLeft), "note");
      DrawRow(&svg, frame, x, scale, row);
      top += kResponsePanel;
    }
    DrawHorizontalAxis(&svg, frame, x, fmt::format("response time [{}]", scale.unit));
    top += kResponseAxis;
  }
  svg.Text(6, kResponseTop - 5, Svg::Anchor::kStart, "% of activations", "tick");
  return {width, static_cast<int>(top), svg.Take()};
}

}  // namespace tcs::report
