#include "coordinator/report/measure_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "coordinator/report/measure_words.h"
#include "coordinator/report/plot.h"
#include "coordinator/report/statistics.h"
#include "coordinator/report/style.h"
#include "coordinator/report/sweep_figure.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

constexpr double kPanelGap = 16, kMeasureEdge = 12, kMeasureTitle = 22, kPanelTitle = 24,
                 kLegendLine = 20, kBelowPanel = 26, kAxisTitle = 18, kMeasureRoom = 14,
                 kMeasureMark = 4.2;
constexpr double kFactorOfLogarithm = 100;
constexpr std::size_t kPanelColumns = 3;

// The divisor that brings values into a unit that reads well, and the unit.
struct MeasureScale {
  double divisor = 1;
  std::string unit;
};

MeasureScale MeasureScaleOf(MeasureUnit unit, double most) {
  switch (unit) {
    case MeasureUnit::kShare:
      return {0.01, "% of all"};
    case MeasureUnit::kSeconds:
      if (most >= 1) return {1, "s"};
      if (most >= 1e-3) return {1e-3, "ms"};
      return most >= 1e-6 ? MeasureScale{1e-6, "µs"} : MeasureScale{1e-9, "ns"};
    case MeasureUnit::kCount:
      return {1, "number"};
    case MeasureUnit::kNumber:
      break;
  }
  return {1, ""};
}

// The vertical axis of all panels.
Axis VerticalAxis(const MeasurePlotData& data, const MeasureScale& scale, double low, double high,
                  int ticks) {
  const bool is_time = data.unit == MeasureUnit::kSeconds;
  if (is_time && low > 0 && high / low > kFactorOfLogarithm) {
    return Axis::Logarithmic(low / scale.divisor, high / scale.divisor);
  }
  double bottom = std::min(0.0, low) / scale.divisor, top = high / scale.divisor;
  if (data.unit == MeasureUnit::kShare && high <= 1 && high > 0.5) top = 100;
  return Axis::Linear(bottom, top > bottom ? top : bottom + 1, ticks);
}

// A sign of its own for each series, so that colours are not all that tells them apart.
std::string MarkAt(double x, double y, int series) {
  const auto at = [](double px, double py) { return Coordinate(px) + " " + Coordinate(py); };
  const double r = kMeasureMark;
  switch (series % 5) {
    case 1:  // a square
      return fmt::format("M{}h{}v{}h{}z", at(x - r * 0.9, y - r * 0.9), Coordinate(1.8 * r),
                         Coordinate(1.8 * r), Coordinate(-1.8 * r));
    case 2:  // a triangle
      return fmt::format("M{}L{}L{}z", at(x, y - 1.2 * r), at(x + 1.15 * r, y + 0.85 * r),
                         at(x - 1.15 * r, y + 0.85 * r));
    case 3:  // a rhombus
      return fmt::format("M{}L{}L{}L{}z", at(x, y - 1.3 * r), at(x + 1.3 * r, y),
                         at(x, y + 1.3 * r), at(x - 1.3 * r, y));
    case 4:  // a triangle on its head
      return fmt::format("M{}L{}L{}z", at(x, y + 1.2 * r), at(x + 1.15 * r, y - 0.85 * r),
                         at(x - 1.15 * r, y - 0.85 * r));
    default:  // a disc
      return fmt::format("M{0}a{1} {1} 0 1 0 {2} 0a{1} {1} 0 1 0 {3} 0z", at(x - r, y),
                         Coordinate(r), Coordinate(2 * r), Coordinate(-2 * r));
  }
}

class MeasureDrawing {
 public:
  MeasureDrawing(const MeasurePlotData& data, int width) : data_(data), width_(width) {
    for (const auto& [at, label] : data.tried) ats_.push_back(at);
    for (const MeasurePanel& panel : data.panels) {
      for (const MeasureCurve& curve : panel.curves) TakeEnds(curve);
    }
    if (data.deadline) {
      low_ = std::min(low_, *data.deadline);
      high_ = std::max(high_, *data.deadline);
    }
    scale_ = MeasureScaleOf(data.unit, high_);
    columns_ = width < kWideWidth ? 1 : std::min(kPanelColumns, data.panels.size());
    y_ = VerticalAxis(data, scale_, low_, high_, columns_ == 1 ? 5 : 4);
    for (const double tick : y_.ticks()) left_ = std::max(left_, WidthOf(y_.Label(tick)) + 14);
  }

  Drawing Take() {
    const std::string unit = scale_.unit.empty() ? "" : fmt::format(" [{}]", scale_.unit);
    svg_.Text(kMeasureEdge / 2, 14, Svg::Anchor::kStart,
              Fitted(MeasureWords(data_.measure) + unit, width_ - kMeasureEdge), "tick");
    double top = kMeasureTitle + DrawLegend(kMeasureTitle);
    const bool has_titles = data_.panels.size() > 1;
    const double pitch =
        (width_ - left_ - kMeasureEdge + kPanelGap) / static_cast<double>(columns_);
    const double height = columns_ > 1 ? 190 : has_titles ? 170 : 280;
    for (std::size_t i = 0; i < data_.panels.size(); ++i) {
      const std::size_t column = i % columns_;
      const double from = left_ + pitch * static_cast<double>(column);
      const double head = top + (has_titles ? kPanelTitle : 6);
      const Frame frame{from, head, from + pitch - kPanelGap, head + height};
      DrawPanel(data_.panels[i], frame, column == 0);
      if (column + 1 == columns_ || i + 1 == data_.panels.size()) top = frame.bottom + kBelowPanel;
    }
    svg_.Text(width_ - kMeasureEdge, top + 10, Svg::Anchor::kEnd,
              Fitted(HorizontalTitle(), width_ - kMeasureEdge), "tick");
    return {width_, static_cast<int>(top + kAxisTitle), svg_.Take()};
  }

 private:
  void TakeEnds(const MeasureCurve& curve) {
    for (const MeasurePoint& point : curve.points) {
      const MeasureSpread spread = MeasureSpreadOf(point.values);
      low_ = std::min(low_, spread.low);
      high_ = std::max(high_, spread.high);
    }
  }

  std::string HorizontalTitle() const {
    return data_.against.ends_with(".speed") ? data_.against + " [times the host's processor]"
                                             : data_.against;
  }

  Axis HorizontalAxis(const Frame& frame) const {
    const auto [least, most] = std::minmax_element(ats_.begin(), ats_.end());
    if (*least == *most) {
      Axis one = Axis::Exact(*least - 1, *least + 1, 2);
      one.Place(frame.left, frame.right);
      return one;
    }
    const bool grows_by_factors = data_.is_numeric && IsGeometric(ats_);
    Axis axis = grows_by_factors ? Axis::Logarithmic(*least, *most) : Axis::Exact(*least, *most, 5);
    // The axis goes only as far as there are values, with room for their marks.
    axis.Place(0, 1);
    const double from = axis.Pixel(*least), to = axis.Pixel(*most);
    const double pixels = (frame.right - frame.left - 2 * kMeasureRoom) / (to - from);
    const double begin = frame.left + kMeasureRoom - from * pixels;
    axis.Place(begin, begin + pixels);
    return axis;
  }

  // Draws the legend in as many lines as it needs; returns its height.
  double DrawLegend(double top) {
    std::vector<std::pair<std::string, int>> names;
    for (const MeasurePanel& panel : data_.panels) {
      for (const MeasureCurve& curve : panel.curves) {
        const std::pair<std::string, int> name{curve.name, curve.colour};
        if (curve.name.empty() || std::find(names.begin(), names.end(), name) != names.end())
          continue;
        names.push_back(name);
      }
    }
    if (names.empty()) return 0;
    double x = kMeasureEdge / 2, y = top + 12;
    if (!data_.curves_are.empty()) {
      const std::string head = Fitted(data_.curves_are + ":", width_ - kMeasureEdge);
      svg_.Text(x, y, Svg::Anchor::kStart, head, "tick");
      x += WidthOf(head) + 10;
    }
    for (const auto& [name, colour] : names) {
      const double wide = 28 + WidthOf(name) + 16;
      if (x > kMeasureEdge && x + wide > width_) {
        x = kMeasureEdge / 2;
        y += kLegendLine;
      }
      svg_.Line(x, y - 4, x + 22, y - 4, "bold " + SeriesClass('s', colour));
      svg_.Path(MarkAt(x + 11, y - 4, colour), SeriesClass('f', colour));
      svg_.Text(x + 28, y, Svg::Anchor::kStart, name, "name " + SeriesClass('t', colour));
      x += wide;
    }
    return y - top + 8;
  }

  void DrawPanel(const MeasurePanel& panel, const Frame& frame, bool has_labels) {
    if (!panel.title.empty()) {
      svg_.Text(frame.left, frame.top - 10, Svg::Anchor::kStart,
                Fitted(panel.title, frame.right - frame.left), "name");
    }
    y_.Place(frame.bottom, frame.top);
    if (has_labels) {
      DrawVerticalAxis(&svg_, frame, y_);
    } else {
      for (const double tick : y_.ticks()) {
        svg_.Line(frame.left, y_.Pixel(tick), frame.right, y_.Pixel(tick), "grid");
      }
    }
    const Axis x = HorizontalAxis(frame);
    if (data_.deadline) {
      const double at = y_.Pixel(*data_.deadline / scale_.divisor);
      svg_.Line(frame.left, at, frame.right, at, "mark");
      svg_.Text(frame.right, at - 5, Svg::Anchor::kEnd, "deadline", "tick");
    }
    for (const MeasureCurve& curve : panel.curves) DrawBand(curve, x);
    for (const MeasureCurve& curve : panel.curves) DrawCurve(curve, x);
    DrawValues(frame, x);
  }

  double Y(double value) const { return y_.Pixel(value / scale_.divisor); }

  void DrawBand(const MeasureCurve& curve, const Axis& x) {
    Svg::Points band;
    for (const MeasurePoint& point : curve.points) {
      band.emplace_back(x.Pixel(point.at), Y(MeasureSpreadOf(point.values).high));
    }
    for (auto point = curve.points.rbegin(); point != curve.points.rend(); ++point) {
      band.emplace_back(x.Pixel(point->at), Y(MeasureSpreadOf(point->values).low));
    }
    svg_.Path(PathThrough(band) + "z", "band " + SeriesClass('f', curve.colour));
  }

  void DrawCurve(const MeasureCurve& curve, const Axis& x) {
    Svg::Points medians;
    for (const MeasurePoint& point : curve.points) {
      const MeasureSpread spread = MeasureSpreadOf(point.values);
      const double at = x.Pixel(point.at);
      medians.emplace_back(at, Y(spread.median));
      // Where nothing is between two values, the spread shows all the same.
      svg_.Line(at, Y(spread.low), at, Y(spread.high), "line " + SeriesClass('s', curve.colour));
    }
    svg_.Polyline(medians, "bold " + SeriesClass('s', curve.colour));
    for (const auto& [at, y] : medians) {
      svg_.Path(MarkAt(at, y, curve.colour), SeriesClass('f', curve.colour));
    }
  }

  // A tick at each value that was tried, and its label where it fits.
  void DrawValues(const Frame& frame, const Axis& x) {
    svg_.Line(frame.left, frame.bottom, frame.right, frame.bottom, "axis");
    std::vector<std::pair<double, std::string>> labels = data_.tried;
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    double free_from = -1e9;
    for (const auto& [value, label] : labels) {
      const double at = x.Pixel(value), half = WidthOf(label) / 2;
      svg_.Line(at, frame.bottom, at, frame.bottom + 4, "axis");
      if (at - half < free_from) continue;
      svg_.Text(at, frame.bottom + 16, Svg::Anchor::kMiddle, label, "tick");
      free_from = at + half + 6;
    }
  }

  const MeasurePlotData& data_;
  const int width_;
  double low_ = 1e300, high_ = -1e300, left_ = 30;
  std::vector<double> ats_;
  MeasureScale scale_;
  std::size_t columns_ = 1;
  Axis y_;
  Svg svg_;
};

}  // namespace

MeasureSpread MeasureSpreadOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {Quantile(values, 0.1), Quantile(values, 0.5), Quantile(values, 0.9)};
}

Drawing DrawMeasure(const MeasurePlotData& data, int width) {
  return MeasureDrawing(data, width).Take();
}

}  // namespace tcs::report
