#include "coordinator/report/tracks_figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/plot.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/style.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kTracksLeft = 44, kTracksRight = 32, kTracksTop = 20, kTracksPanel = 120,
                 kTracksName = 34, kTracksBottom = 40;

// As many of the samples as one can see, the last one included.
Svg::Points Thinned(const Track& track, const Axis& x, const Axis& y, double pixels) {
  Svg::Points points;
  const std::size_t n = track.time_s.size();
  const auto step = std::max<std::size_t>(
      1, static_cast<std::size_t>(static_cast<double>(n) / std::max(1.0, pixels)));
  const auto add = [&](std::size_t i) {
    points.emplace_back(x.Pixel(track.time_s[i]), y.Pixel(track.distance_m[i]));
  };
  for (std::size_t i = 0; i < n; i += step) add(i);
  if (n > 0 && (n - 1) % step != 0) add(n - 1);
  return points;
}

}  // namespace

Track MedianTrack(const System& system) {
  Track median;
  if (system.runs.empty()) return median;
  const Track& first = system.runs.front().track;
  std::vector<double> here;
  for (std::size_t i = 0; i < first.time_s.size(); ++i) {
    here.clear();
    for (const Run& run : system.runs) {
      if (i < run.track.time_s.size() && run.track.time_s[i] == first.time_s[i]) {
        here.push_back(run.track.distance_m[i]);
      }
    }
    median.time_s.push_back(first.time_s[i]);
    median.distance_m.push_back(SpreadOf(here).median);
  }
  return median;
}

Drawing DrawTracks(const std::vector<TracksPanel>& panels, const std::vector<double>& marks,
                   int width) {
  double last = 0, most = 0;
  for (const double mark : marks) most = std::max(most, mark);
  for (const TracksPanel& panel : panels) {
    for (const Run& run : panel.system->runs) {
      if (run.track.time_s.empty()) continue;
      last = std::max(last, run.track.time_s.back());
      most = std::max(most,
                      *std::max_element(run.track.distance_m.begin(), run.track.distance_m.end()));
    }
  }
  const double right = width - kTracksRight;
  Axis x = Axis::Exact(0, last, width < kWideWidth ? 5 : 10);
  x.Place(kTracksLeft, right);
  Svg svg;
  const double pitch = kTracksName + kTracksPanel;
  const double bottom = kTracksTop + pitch * static_cast<double>(panels.size());
  const double points = (right - kTracksLeft) * 0.6;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const System& system = *panels[i].system;
    const int colour = panels[i].colour;
    const double top = kTracksTop + pitch * static_cast<double>(i) + kTracksName;
    const Frame frame{kTracksLeft, top, right, top + kTracksPanel};
    Axis y = Axis::Linear(0, most, 4);
    y.Place(frame.bottom, frame.top);
    DrawVerticalAxis(&svg, frame, y);
    for (const double mark : marks) {
      svg.Line(frame.left, y.Pixel(mark), frame.right, y.Pixel(mark), "mark");
      svg.Text(frame.right + 4, y.Pixel(mark) + 4, Svg::Anchor::kStart, PlainMetres(mark), "tick");
    }
    svg.Text(frame.left, frame.top - 8, Svg::Anchor::kStart, system.name,
             "name " + SeriesClass('t', colour));
    const auto trials = static_cast<std::int64_t>(system.runs.size());
    svg.Text(frame.right, frame.top - 8, Svg::Anchor::kEnd, Count(trials, "trial"), "note");
    for (const Run& run : system.runs) {
      svg.Polyline(Thinned(run.track, x, y, points),
                   (trials > 1 ? "thin " : "line ") + SeriesClass('s', colour));
    }
    if (trials > 1) {
      const Svg::Points median = Thinned(MedianTrack(system), x, y, points);
      svg.Polyline(median, "halo");
      svg.Polyline(median, "bold " + SeriesClass('s', colour));
    }
    svg.Line(frame.left, frame.bottom, frame.right, frame.bottom, "axis");
  }
  DrawHorizontalAxis(&svg, {kTracksLeft, kTracksTop, right, bottom}, x, "virtual time [s]");
  svg.Text(6, kTracksTop - 5, Svg::Anchor::kStart, "distance [m]", "tick");
  return {width, static_cast<int>(bottom + kTracksBottom), svg.Take()};
}

}  // namespace tcs::report
