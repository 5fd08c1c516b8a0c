#include "coordinator/report/timeline_figure.h"

#include <algorithm>
#include <cmath>

#include "coordinator/report/plot.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kTimelineTop = 6, kTimelineTitle = 24, kTimelineRow = 18, kTimelineBetween = 6,
                 kNameAbove = 15, kProgress = 56, kTimelineBottom = 40, kTimelineRight = 60;
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
    const auto ran = static_cast<double>(real ? slice.real_ran : slice.virtual_ran);
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
    for (const Timeline& timeline : timelines) real_ = real_ && timeline.has_real_times;
    double names = WidthOf("virtual time [s]");
    for (const Timeline& timeline : timelines) {
      end_us_ = std::max(end_us_, EndOf(timeline));
      for (const std::string& row : timeline.rows) names = std::max(names, WidthOf(row));
    }
    left_ = narrow_ ? 8 : std::min(names, 200.0) + 14;
    right_ = width - kTimelineRight;
    x_ = Axis::Exact(0, end_us_ * 1e-6, narrow_ ? 4 : 8);
    x_.Place(left_, right_);
  }

  Drawing Draw() {
    for (const Timeline& timeline : timelines_) DrawOne(timeline);
    DrawHorizontalAxis(&svg_, {left_, kTimelineTop, right_, y_}, x_,
                       real_ ? "real time [s]" : "virtual time [s]");
    return {width_, static_cast<int>(y_ + kTimelineBottom), svg_.Take()};
  }

 private:
  double EndOf(const Timeline& timeline) const {
    return static_cast<double>(real_ ? timeline.real_end : timeline.virtual_end);
  }

  void DrawOne(const Timeline& timeline) {
    y_ += kTimelineTitle;
    svg_.Text(8, y_ - 8, Svg::Anchor::kStart, timeline.name, "name");
    for (std::size_t row = 0; row < timeline.rows.size(); ++row) {
      Label(timeline.rows[row]);
      DrawRow(timeline, static_cast<int>(row));
      y_ += kTimelineRow + kTimelineBetween;
    }
    if (!timeline.has_real_times) return;
    Label(real_ ? "virtual time [s]" : "real time [s]");
    DrawProgress(timeline);
    y_ += kProgress + kTimelineBetween;
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
    const std::vector<double> busy = Busy(timeline, row, real_, end_us_, columns);
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
      ran += static_cast<double>(real_ ? slice.real_ran : slice.virtual_ran);
    }
    const std::string share = Percent(ran / std::max(1.0, EndOf(timeline)));
    svg_.Text(right_ + 4, y_ + 13, Svg::Anchor::kStart, share, "tick");
  }

  // How far the world has come in the other time.
  void DrawProgress(const Timeline& timeline) {
    const auto end = static_cast<double>(real_ ? timeline.virtual_end : timeline.real_end) * 1e-6;
    Axis up = Axis::Exact(0, end, 1);
    up.Place(y_ + kProgress, y_);
    svg_.Rect(left_, y_, right_ - left_, kProgress, "lane");
    const auto& rows = timeline.rows;
    const auto dynamics = std::find(rows.begin(), rows.end(), "dynamics") - rows.begin();
    const bool any_row = dynamics == static_cast<std::ptrdiff_t>(rows.size());
    Svg::Points points;
    for (const Slice& slice : timeline.slices) {
      if (!any_row && slice.row != dynamics) continue;
      for (const auto& [real_us, virtual_us] : {std::pair(slice.real_start, slice.virtual_start),
                                                std::pair(slice.real_end, slice.virtual_end)}) {
        const std::pair<double, double> point{
            x_.Pixel(static_cast<double>(real_ ? real_us : virtual_us) * 1e-6),
            up.Pixel(static_cast<double>(real_ ? virtual_us : real_us) * 1e-6)};
        // One point a column is enough; the last one stays.
        if (points.size() > 1 && point.first - points[points.size() - 2].first < 0.5) {
          points.pop_back();
        }
        points.push_back(point);
      }
    }
    svg_.Polyline(points, "progress");
    svg_.Text(right_ + 4, y_ + 10, Svg::Anchor::kStart, Significant(end), "tick");
    svg_.Text(right_ + 4, y_ + kProgress, Svg::Anchor::kStart, "0", "tick");
  }

  const std::vector<Timeline>& timelines_;
  const int width_;
  const bool narrow_;
  bool real_ = true;
  double end_us_ = 1, left_ = 0, right_ = 0, y_ = kTimelineTop;
  Axis x_;
  Svg svg_;
};

}  // namespace

Drawing DrawTimelines(const std::vector<Timeline>& timelines, int width) {
  return Picture(timelines, width).Draw();
}

}  // namespace tcs::report
