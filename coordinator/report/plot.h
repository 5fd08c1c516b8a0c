// The parts that the figures have in common: the frame around a plot, and labels.
#pragma once

#include <string>

#include "coordinator/report/axis.h"
#include "coordinator/report/svg.h"

namespace tcs::report {

// A plot's place in its picture, in pixels.
struct Frame {
  double left = 0, top = 0, right = 0, bottom = 0;
};

// Horizontal grid lines and their labels, left of the frame.
void DrawVerticalAxis(Svg* svg, const Frame& frame, const Axis& axis);

// The line below, ticks, and their labels where they fit; `title` is written below, at the right.
void DrawHorizontalAxis(Svg* svg, const Frame& frame, const Axis& axis, const std::string& title);

// A dashed vertical line with `label` above the frame.
void DrawMark(Svg* svg, const Frame& frame, double x, const std::string& label);

// `text`, cut off with an ellipsis where it is wider than `pixels`.
[[nodiscard]] std::string Fitted(const std::string& text, double pixels);

}  // namespace tcs::report
