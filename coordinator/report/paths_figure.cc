#include "coordinator/report/paths_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "coordinator/report/plot.h"
#include "coordinator/report/style.h"

namespace tcs::report {
namespace {

constexpr double kPathsLeft = 44, kPathsRight = 12, kPathsTop = 26, kPathsBottom = 24,
                 kPathsBetween = 60;
constexpr double kMostHeight = 380, kLeastHeight = 70;
constexpr double kPathsPanel = 92, kAbove = 30, kBelow = 40;
constexpr std::size_t kMostPoints = 500, kMostRobots = 4;

struct Span {
  double least = std::numeric_limits<double>::infinity(),
         most = -std::numeric_limits<double>::infinity();

  double size() const { return most - least; }
  double middle() const { return (least + most) / 2; }
  void Add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

Span SpanOf(const Replay& replay, std::size_t axis) {
  Span span;
  for (const RobotTracks& robot : replay.robots) {
    for (const std::size_t path : robot.paths) {
      for (const PoseRow& pose : replay.tracks[path].poses) span.Add(pose[axis]);
    }
  }
  return span;
}

std::size_t StrideOf(std::size_t count) { return std::max<std::size_t>(1, count / kMostPoints); }

class View {
 public:
  View(const Replay& replay, std::size_t across, std::size_t up, double scale, Frame frame)
      : replay_(replay), across_(across), up_(up), frame_(frame) {
    const double x = SpanOf(replay, across).middle(), y = SpanOf(replay, up).middle();
    const double wide = (frame.right - frame.left) / 2 / scale;
    const double high = (frame.bottom - frame.top) / 2 / scale;
    x_ = Axis::Exact(x - wide, x + wide, frame.right - frame.left > 300 ? 6 : 4);
    y_ = Axis::Exact(y - high, y + high, frame.bottom - frame.top > 200 ? 6 : 3);
    x_.Place(frame.left, frame.right);
    y_.Place(frame.bottom, frame.top);
  }

  void Draw(const std::string& title, Svg* svg) const {
    svg->Rect(frame_.left, frame_.top, frame_.right - frame_.left, frame_.bottom - frame_.top,
              "lane");
    svg->Text(frame_.left, frame_.top - 8, Svg::Anchor::kStart, title, "name");
    DrawVerticalAxis(svg, frame_, y_);
    for (const double tick : x_.ticks()) {
      svg->Line(x_.Pixel(tick), frame_.top, x_.Pixel(tick), frame_.bottom, "grid");
      svg->Text(x_.Pixel(tick), frame_.bottom + 15, Svg::Anchor::kMiddle, x_.Label(tick), "tick");
    }
    for (std::size_t i = 0; i < replay_.robots.size(); ++i) {
      for (const std::size_t path : replay_.robots[i].paths)
        DrawPath(path, static_cast<int>(i), svg);
    }
  }

 private:
  void DrawPath(std::size_t path, int colour, Svg* svg) const {
    const auto& poses = replay_.tracks[path].poses;
    Svg::Points points;
    for (std::size_t i = 0; i < poses.size(); i += StrideOf(poses.size()))
      points.push_back(At(poses[i]));
    svg->Polyline(points, "line " + SeriesClass('s', colour));
    const auto [x, y] = At(poses.back());
    svg->Circle(x, y, replay_.robots.size() > 8 ? 3 : 4.5, SeriesClass('f', colour));
  }
  std::pair<double, double> At(const PoseRow& pose) const {
    return {x_.Pixel(pose[across_]), y_.Pixel(pose[up_])};
  }

  const Replay& replay_;
  const std::size_t across_, up_;
  const Frame frame_;
  Axis x_, y_;
};

// The robots that have been at more than one place.
std::vector<std::size_t> Moving(const Replay& replay) {
  std::vector<std::size_t> moving;
  for (std::size_t i = 0; i < replay.robots.size() && moving.size() < kMostRobots; ++i) {
    if (!replay.tracks[replay.robots[i].paths.front()].IsStill()) moving.push_back(i);
  }
  return moving;
}

}  // namespace

Drawing DrawPaths(const Replay& replay, int width) {
  const bool narrow = width < kWideWidth;
  const std::array<double, 3> sizes{SpanOf(replay, 0).size(), SpanOf(replay, 1).size(),
                                    SpanOf(replay, 2).size()};
  const double most = std::max(1e-3, *std::max_element(sizes.begin(), sizes.end()));
  const auto room = [&](std::size_t axis) { return std::max(sizes[axis], most * 0.3) * 1.12; };
  const double plot = narrow ? width - kPathsLeft - kPathsRight
                             : (width - kPathsLeft - kPathsRight - kPathsBetween) / 2;
  const double scale =
      std::min(plot / room(0), (narrow ? 320 : kMostHeight) / std::max(room(1), room(2)));
  const double above = std::max(kLeastHeight, room(1) * scale);
  const double aside = std::max(kLeastHeight, room(2) * scale);
  const double second_left = narrow ? kPathsLeft : kPathsLeft + plot + kPathsBetween;
  const double second_top = narrow ? kPathsTop + above + kPathsBottom + 34 : kPathsTop;
  Svg svg;
  View(replay, 0, 1, scale, {kPathsLeft, kPathsTop, kPathsLeft + plot, kPathsTop + above})
      .Draw("from above: y [m] over x [m]", &svg);
  View(replay, 0, 2, scale, {second_left, second_top, second_left + plot, second_top + aside})
      .Draw("from the side: z [m] over x [m]", &svg);
  const double height = narrow ? second_top + aside : kPathsTop + std::max(above, aside);
  return {width, static_cast<int>(height + kPathsBottom), svg.Take()};
}

Drawing DrawMotion(const Replay& replay, int width) {
  Svg svg;
  const double right = width - kPathsRight;
  Axis x = Axis::Exact(0, replay.end_s, width < kWideWidth ? 4 : 9);
  x.Place(kPathsLeft, right);
  double y = 0;
  for (const std::size_t robot : Moving(replay)) {
    const auto& poses = replay.tracks[replay.robots[robot].paths.front()].poses;
    Span span;
    for (const PoseRow& pose : poses) {
      for (std::size_t axis = 0; axis < 3; ++axis) span.Add(pose[axis]);
    }
    const double room = std::max(0.01, span.size() * 0.06);
    y += kAbove;
    const Frame frame{kPathsLeft, y, right, y + kPathsPanel};
    svg.Rect(kPathsLeft, y, right - kPathsLeft, kPathsPanel, "lane");
    Axis up = Axis::Exact(span.least - room, span.most + room, 4);
    up.Place(frame.bottom, frame.top);
    DrawVerticalAxis(&svg, frame, up);
    svg.Text(kPathsLeft, y - 8, Svg::Anchor::kStart, replay.robots[robot].name + ": position [m]",
             "name");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Svg::Points points;
      for (std::size_t i = 0; i < poses.size(); i += StrideOf(poses.size())) {
        points.emplace_back(x.Pixel(replay.time_s[i]), up.Pixel(poses[i][axis]));
      }
      svg.Polyline(points, "line " + SeriesClass('s', static_cast<int>(axis)));
      svg.Text(right - 36 + 14 * static_cast<double>(axis), y - 8, Svg::Anchor::kStart,
               std::string(1, "xyz"[axis]), SeriesClass('t', static_cast<int>(axis)));
    }
    y += kPathsPanel;
  }
  DrawHorizontalAxis(&svg, {kPathsLeft, 0, right, y}, x, "virtual time [s]");
  return {width, static_cast<int>(y + kBelow), svg.Take()};
}

}  // namespace tcs::report
