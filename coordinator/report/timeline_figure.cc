#include "coordinator/report/timeline_figure.h"

#include <algorithm>
#include <cmath>

#include "coordinator/report/plot.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kTop = 6, kTitle = 24, kRow = 18, kBetween = 6, kNameAbove = 15, kProgress = 56,
                 kBottom = 40, kRight = 44;
// What ran and took none of this axis's time is seen all the same.
constexpr double kLeastShare = 0.12;

// Of `columns` equal parts of 0 … `end`, the share that the row's slices fill.
std::vector<double> Busy(const Timeline& timeline, int row, bool real, double end,
                         std::size_t columns) {
  std::vector<double> busy(columns, 0.0);
  const double width = end / static_cast<double>(columns);
  for (const Slice& slice : timeline.slices) {
    if (slice.row != row) continue;
    const auto from = static_cast<double>(real ? slice.real_start : slice.virtual_start);
    const auto to = static_cast<double>(real ? slice.real_end : slice.virtual_end);
    const auto first = std::min(columns - 1, static_cast<std::size_t>(from / width));
    const auto last = std::min(columns - 1, static_cast<std::size_t>(to / width));
    for (std::size_t i = first; i <= last; ++i) {
      const double left = static_cast<double>(i) * width;
      const double share = (std::min(to, left + width) - std::max(from, left)) / width;
      busy[i] = std::max(1e-6, busy[i] + std::max(0.0, share));
    }
  }
  for (double& share : busy) share = share > 0 ? std::clamp(share, kLeastShare, 1.0) : 0.0;
  return busy;
}

// The dynamics' progress over the other time.
Svg::Points Progress(const Timeline& timeline, bool over_real, const Axis& x, const Axis& y) {
  Svg::Points points;
  const auto dynamics = std::find(timeline.rows.begin(), timeline.rows.end(), "dynamics");
  const auto row = static_cast<int>(dynamics - timeline.rows.begin());
  double last = -1e9;
  for (const Slice& slice : timeline.slices) {
    if (dynamics != timeline.rows.end() && slice.row != row) continue;
    const std::pair<std::int64_t, std::int64_t> edges[] = {{slice.real_start, slice.virtual_start},
                                                           {slice.real_end, slice.virtual_end}};
    for (const auto& [real_us, virtual_us] : edges) {
      const double at = x.Pixel(static_cast<double>(over_real ? real_us : virtual_us) * 1e-6);
      if (at - last < 0.5) continue;
      last = at;
      points.emplace_back(at,
                          y.Pixel(static_cast<double>(over_real ? virtual_us : real_us) * 1e-6));
    }
  }
  return points;
}

}  // namespace

Drawing DrawTimelines(const std::vector<Timeline>& timelines, int width) {
  const bool narrow = width < kWideWidth;
  bool real = true;
  for (const Timeline& timeline : timelines) real = real && timeline.has_real_times;
  double end = 0, other_end = 0, names = 0;
  for (const Timeline& timeline : timelines) {
    end = std::max(end, static_cast<double>(real ? timeline.real_end : timeline.virtual_end));
    other_end = std::max(other_end, static_cast<double>(timeline.virtual_end));
    for (const std::string& row : timeline.rows) names = std::max(names, WidthOf(row));
  }
  const double left = narrow ? 8 : std::min(names, 200.0) + 14, right = width - kRight;
  Axis x = Axis::Exact(0, end * 1e-6, narrow ? 4 : 8);
  x.Place(left, right);
  Svg svg;
  double y = kTop;
  for (const Timeline& timeline : timelines) {
    y += kTitle;
    svg.Text(8, y - 8, Svg::Anchor::kStart, timeline.name, "name");
    for (std::size_t row = 0; row < timeline.rows.size(); ++row) {
      if (narrow) {
        y += kNameAbove;
        svg.Text(left, y - 4, Svg::Anchor::kStart, timeline.rows[row], "note");
      } else {
        svg.Text(left - 6, y + 13, Svg::Anchor::kEnd, Fitted(timeline.rows[row], left - 14),
                 "note");
      }
      svg.Rect(left, y, right - left, kRow, "lane");
      const auto columns = static_cast<std::size_t>(right - left);
      const std::vector<double> busy = Busy(timeline, static_cast<int>(row), real, end, columns);
      Svg::Points outline;
      for (std::size_t i = 0; i < columns; ++i) {
        const double height = y + kRow * (1 - busy[i]);
        outline.emplace_back(left + static_cast<double>(i), height);
        outline.emplace_back(left + static_cast<double>(i + 1), height);
      }
      svg.Area(outline, y + kRow, "busy");
      y += kRow + kBetween;
    }
    if (!timeline.has_real_times) continue;
    if (narrow) {
      y += kNameAbove;
      svg.Text(left, y - 4, Svg::Anchor::kStart, "virtual time", "note");
    } else {
      svg.Text(left - 6, y + 13, Svg::Anchor::kEnd, "virtual time", "note");
    }
    Axis up = Axis::Exact(0, other_end * 1e-6, 1);
    up.Place(y + kProgress, y);
    svg.Rect(left, y, right - left, kProgress, "lane");
    svg.Polyline(Progress(timeline, real, x, up), "progress");
    svg.Text(right + 4, y + 10, Svg::Anchor::kStart, Significant(other_end * 1e-6) + " s", "tick");
    svg.Text(right + 4, y + kProgress, Svg::Anchor::kStart, "0 s", "tick");
    y += kProgress + kBetween;
  }
  DrawHorizontalAxis(&svg, {left, kTop, right, y}, x, real ? "real time [s]" : "virtual time [s]");
  return {width, static_cast<int>(y + kBottom), svg.Take()};
}

}  // namespace tcs::report
