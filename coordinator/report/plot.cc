#include "coordinator/report/plot.h"

#include <algorithm>

namespace tcs::report {

namespace {

constexpr double kTickLength = 4, kTickText = 16, kTitleText = 33, kBetweenLabels = 8,
                 kLeastMargin = 10;

}  // namespace

void DrawVerticalAxis(Svg* svg, const Frame& frame, const Axis& axis) {
  for (const double tick : axis.ticks()) {
    const double y = axis.Pixel(tick);
    svg->Line(frame.left, y, frame.right, y, "grid");
    svg->Text(frame.left - 6, y + 4, Svg::Anchor::kEnd, axis.Label(tick), "tick");
  }
}

void DrawHorizontalAxis(Svg* svg, const Frame& frame, const Axis& axis, const std::string& title) {
  svg->Line(frame.left, frame.bottom, frame.right, frame.bottom, "axis");
  double free_from = -1e9;
  for (const double tick : axis.ticks()) {
    const double x = axis.Pixel(tick);
    svg->Line(x, frame.bottom, x, frame.bottom + kTickLength, "axis");
    const std::string label = axis.Label(tick);
    const double half = WidthOf(label) / 2;
    if (x - half < free_from) continue;
    // A label at the end of the axis stays in the picture, as far as the narrowest margin goes.
    svg->Text(std::min(x, frame.right + kLeastMargin - half), frame.bottom + kTickText,
              Svg::Anchor::kMiddle, label, "tick");
    free_from = x + half + kBetweenLabels;
  }
  svg->Text(frame.right, frame.bottom + kTitleText, Svg::Anchor::kEnd, title, "tick");
}

void DrawMark(Svg* svg, const Frame& frame, double x, const std::string& label) {
  svg->Line(x, frame.top, x, frame.bottom, "mark");
  const double half = WidthOf(label) / 2;
  const double at =
      std::clamp(x, frame.left + half, std::max(frame.left + half, frame.right - half));
  svg->Text(at, frame.top - 5, Svg::Anchor::kMiddle, label, "tick");
}

std::string Fitted(const std::string& text, double pixels) {
  if (WidthOf(text) <= pixels) return text;
  std::string fitted = text;
  while (!fitted.empty() && WidthOf(fitted) + 7 > pixels) {
    while (!fitted.empty() && (static_cast<unsigned char>(fitted.back()) & 0xC0) == 0x80) {
      fitted.pop_back();
    }
    if (!fitted.empty()) fitted.pop_back();
  }
  return fitted + "…";
}

}  // namespace tcs::report
