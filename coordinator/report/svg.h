// Drawing in SVG. Coordinates are pixels, y downwards. Colours and line widths come from classes
// (style.h), so that a page can be read in the dark.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tcs::report {

// A picture: its size, and the elements inside.
struct Drawing {
  int width = 0, height = 0;
  std::string content;
};

class Svg {
 public:
  using Points = std::vector<std::pair<double, double>>;
  enum class Anchor { kStart, kMiddle, kEnd };

  void Line(double x1, double y1, double x2, double y2, std::string_view classes);
  void Rect(double x, double y, double width, double height, std::string_view classes);
  void Circle(double x, double y, double radius, std::string_view classes);
  void Polyline(const Points& points, std::string_view classes);
  // `outline` and back along the line y = `base`.
  void Area(const Points& outline, double base, std::string_view classes);
  void Path(std::string_view commands, std::string_view classes);
  // y is the baseline. `text` is plain, and is escaped here.
  void Text(double x, double y, Anchor anchor, std::string_view text, std::string_view classes);

  [[nodiscard]] std::string Take() { return std::move(content_); }

 private:
  std::string content_;
};

// "12.5", "-3", "7": no more digits than one can see.
[[nodiscard]] std::string Coordinate(double value);

// The commands of a path through `points`, each relative to the one before.
[[nodiscard]] std::string PathThrough(const Svg::Points& points);

// About how wide `text` is at the size of labels.
[[nodiscard]] double WidthOf(std::string_view text);

}  // namespace tcs::report
