#include "coordinator/report/lateness_figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/plot.h"
#include "coordinator/report/style.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kLatenessLeft = 12, kLatenessRight = 84, kLatenessTop = 8, kLatenessGroup = 24,
                 kLatenessRow = 34, kLatenessBottom = 40, kZero = 30;
constexpr double kUs = 1e6;

}  // namespace

Drawing DrawLateness(const std::vector<LatenessGroup>& groups, int width) {
  double least = 1e9, most = 0;
  for (const LatenessGroup& group : groups) {
    for (const LatenessRow& row : group.rows) {
      for (const double value : {row.median_s, row.high_s, row.most_s}) {
        if (value > 0) least = std::min(least, value * kUs);
        most = std::max(most, value * kUs);
      }
    }
  }
  // A logarithm has no zero: what is not late at all has a place of its own, left of the axis.
  Axis x = Axis::Decades(most > 0 ? std::clamp(least, 0.1, most) : 1, std::max(most, 1.0));
  const double right = width - kLatenessRight;
  x.Place(kLatenessLeft + kZero, right);
  const auto at = [&](double seconds) {
    return seconds * kUs < x.low() ? kLatenessLeft + 4 : x.Pixel(seconds * kUs);
  };
  Svg svg;
  double y = kLatenessTop;
  for (const LatenessGroup& group : groups) {
    y += kLatenessGroup;
    svg.Text(kLatenessLeft, y - 6, Svg::Anchor::kStart, group.name, "name");
    for (const LatenessRow& row : group.rows) {
      svg.Text(kLatenessLeft, y + 10, Svg::Anchor::kStart, row.name, SeriesClass('t', row.colour));
      const double line = y + 21;
      svg.Line(kLatenessLeft, line, right, line, "grid");
      svg.Line(at(row.median_s), line, at(row.most_s), line,
               "line " + SeriesClass('s', row.colour));
      svg.Line(at(row.median_s), line, at(row.high_s), line,
               "bold " + SeriesClass('s', row.colour));
      svg.Line(at(row.most_s), line - 4, at(row.most_s), line + 4,
               "line " + SeriesClass('s', row.colour));
      svg.Circle(at(row.median_s), line, 4, SeriesClass('f', row.colour));
      svg.Text(right + 8, line + 4, Svg::Anchor::kStart, Seconds(row.most_s, 2), "note");
      y += kLatenessRow;
    }
  }
  const double bottom = y + 4;
  svg.Text(width - 4, kLatenessTop + 10, Svg::Anchor::kEnd, "most", "tick");
  svg.Text(kLatenessLeft + 4, bottom + 16, Svg::Anchor::kMiddle, "0", "tick");
  DrawHorizontalAxis(&svg, {kLatenessLeft + kZero, kLatenessTop, right, bottom}, x, "late by [µs]");
  return {width, static_cast<int>(bottom + kLatenessBottom), svg.Take()};
}

}  // namespace tcs::report
