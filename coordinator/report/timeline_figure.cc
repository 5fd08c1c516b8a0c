#include "coordinator/report/timeline_figure.h"

#include <algorithm>
#include <cmath>

#include "coordinator/report/plot.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kTimelineTop = 6, kTimelineTitle = 24, kTimelineRow = 18, kTimelineBetween = 6,
                 kNameAbove = 15, kTimelineBottom = 40, kTimelineRight = 60;
// A slice that took none of this axis's time is seen all the same.
constexpr double kLeastShare = 0.12;

// Of `columns` equal parts of 0 … `end`, the share that the row's slices fill.
std::vector<double> Busy(const Timeline& timeline, int row, double end, std::size_t columns) {
  std::vector<double> busy(columns, 0.0);
  const double width = end / static_cast<double>(columns);
  for (const Slice& slice : timeline.slices) {
    if (slice.row != row) continue;
    const auto from = static_cast<double>(slice.virtual_start);
    const auto to = static_cast<double>(slice.virtual_end);
    const auto ran = static_cast<double>(slice.virtual_ran);
    const double density = to > from ? ran / (to - from) : 1.0;
    const auto first = std::min(columns - 1, static_cast<std::size_t>(from / width));
    const auto last = std::min(columns - 1, static_cast<std::size_t>(to / width));
    for (std::size_t i = first; i <= last; ++i) {
      const double left = static_cast<double>(i) * width;
      const double inside = std::min(to, left + width) - std::max(from, left);
      busy[i] = std::max(1e-6, busy[i] + density * std::max(0.0, inside) / width);
    }
  }
  for (double& share : busy) share = share > 0 ? std::clamp(share, kLeastShare, 1.0) : 0.0;
  return busy;
}

class Picture {
 public:
  Picture(const std::vector<Timeline>& timelines, int width)
      : timelines_(timelines), width_(width), narrow_(width < kWideWidth) {
    double names = 0;
    for (const Timeline& timeline : timelines) {
      end_us_ = std::max(end_us_, static_cast<double>(timeline.virtual_end));
      for (const std::string& row : timeline.rows) names = std::max(names, WidthOf(row));
    }
    left_ = narrow_ ? 8 : std::min(names, 200.0) + 14;
    right_ = width - kTimelineRight;
    x_ = Axis::Exact(0, end_us_ * 1e-6, narrow_ ? 4 : 8);
    x_.Place(left_, right_);
  }

  Drawing Draw() {
    for (const Timeline& timeline : timelines_) DrawOne(timeline);
    DrawHorizontalAxis(&svg_, {left_, kTimelineTop, right_, y_}, x_, "virtual time [s]");
    return {width_, static_cast<int>(y_ + kTimelineBottom), svg_.Take()};
  }

 private:
  void DrawOne(const Timeline& timeline) {
    y_ += kTimelineTitle;
    svg_.Text(8, y_ - 8, Svg::Anchor::kStart, timeline.name, "name");
    for (std::size_t row = 0; row < timeline.rows.size(); ++row) {
      if (timeline.rows[row] == kDynamicsRow) continue;  // all of virtual time is the dynamics'
      Label(timeline.rows[row]);
      DrawRow(timeline, static_cast<int>(row));
      y_ += kTimelineRow + kTimelineBetween;
    }
  }

  void Label(const std::string& name) {
    if (narrow_) {
      y_ += kNameAbove;
      svg_.Text(left_, y_ - 4, Svg::Anchor::kStart, name, "note");
    } else {
      svg_.Text(left_ - 6, y_ + 13, Svg::Anchor::kEnd, Fitted(name, left_ - 8), "note");
    }
  }

  void DrawRow(const Timeline& timeline, int row) {
    svg_.Rect(left_, y_, right_ - left_, kTimelineRow, "lane");
    const auto columns = static_cast<std::size_t>(right_ - left_);
    const std::vector<double> busy = Busy(timeline, row, end_us_, columns);
    Svg::Points outline;
    for (std::size_t i = 0; i < columns; ++i) {
      const double height = y_ + kTimelineRow * (1 - busy[i]);
      outline.emplace_back(left_ + static_cast<double>(i), height);
      outline.emplace_back(left_ + static_cast<double>(i + 1), height);
    }
    svg_.Area(outline, y_ + kTimelineRow, "busy");
    double ran = 0;
    for (const Slice& slice : timeline.slices) {
      if (slice.row != row) continue;
      ran += static_cast<double>(slice.virtual_ran);
    }
    const std::string share =
        Percent(ran / std::max(1.0, static_cast<double>(timeline.virtual_end)));
    svg_.Text(right_ + 4, y_ + 13, Svg::Anchor::kStart, share, "tick");
    DrawMisses(timeline, row);
  }

  // A mark per pixel is enough.
  void DrawMisses(const Timeline& timeline, int row) {
    long last = -1;
    for (const Miss& miss : timeline.misses) {
      const double x = x_.Pixel(static_cast<double>(miss.due_us) * 1e-6);
      if (miss.row != row || std::lround(x) == last || x > right_) continue;
      last = std::lround(x);
      svg_.Line(x, y_, x, y_ + kTimelineRow, "miss");
    }
  }

  const std::vector<Timeline>& timelines_;
  const int width_;
  const bool narrow_;
  double end_us_ = 1, left_ = 0, right_ = 0, y_ = kTimelineTop;
  Axis x_;
  Svg svg_;
};

}  // namespace

Drawing DrawTimelines(const std::vector<Timeline>& timelines, int width) {
  return Picture(timelines, width).Draw();
}

}  // namespace tcs::report
