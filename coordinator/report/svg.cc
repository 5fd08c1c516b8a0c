#include "coordinator/report/svg.h"

#include <fmt/format.h>

#include <cmath>

#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

// In tenths of a pixel, so that rounding does not add up along a relative path.
std::string Tenths(long tenths) {
  const char* sign = tenths < 0 ? "-" : "";
  const long size = std::labs(tenths);
  if (size % 10 == 0) return fmt::format("{}{}", sign, size / 10);
  if (size < 10) return fmt::format("{}.{}", sign, size);
  return fmt::format("{}{}.{}", sign, size / 10, size % 10);
}

long ToTenths(double value) { return std::lround(value * 10.0); }

void Append(std::string* path, long value) {
  const std::string text = Tenths(value);
  const char last = path->back();
  const bool apart = text.front() == '-' || last < '.' || last > '9';
  if (!apart) *path += ' ';
  *path += text;
}

}  // namespace

std::string Coordinate(double value) { return Tenths(ToTenths(value)); }

std::string PathThrough(const Svg::Points& points) {
  std::string path;
  long x = 0, y = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const long next_x = ToTenths(points[i].first), next_y = ToTenths(points[i].second);
    if (i == 0) path += 'M';
    if (i == 1) path += 'l';
    if (i > 0 && next_x == x && next_y == y) continue;
    Append(&path, i == 0 ? next_x : next_x - x);
    Append(&path, i == 0 ? next_y : next_y - y);
    x = next_x;
    y = next_y;
  }
  if (!path.empty() && path.back() == 'l') path.pop_back();
  return path;
}

double WidthOf(std::string_view text) {
  double width = 0;
  for (const char c : text) {
    // Continuation bytes belong to the character before.
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) width += 6.4;
  }
  return width;
}

void Svg::Line(double x1, double y1, double x2, double y2, std::string_view classes) {
  content_ += fmt::format("<path class=\"{}\" d=\"M{} {}L{} {}\"/>", classes, Coordinate(x1),
                          Coordinate(y1), Coordinate(x2), Coordinate(y2));
}

void Svg::Rect(double x, double y, double width, double height, std::string_view classes) {
  content_ +=
      fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>", classes,
                  Coordinate(x), Coordinate(y), Coordinate(width), Coordinate(height));
}

void Svg::Circle(double x, double y, double radius, std::string_view classes) {
  content_ += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>", classes,
                          Coordinate(x), Coordinate(y), Coordinate(radius));
}

void Svg::Path(std::string_view commands, std::string_view classes) {
  content_ += fmt::format("<path class=\"{}\" d=\"{}\"/>", classes, commands);
}

void Svg::Polyline(const Points& points, std::string_view classes) {
  if (points.size() > 1) Path(PathThrough(points), classes);
}

void Svg::Area(const Points& outline, double base, std::string_view classes) {
  if (outline.empty()) return;
  Points closed = outline;
  closed.emplace_back(outline.back().first, base);
  closed.emplace_back(outline.front().first, base);
  Path(PathThrough(closed) + "z", classes);
}

void Svg::Text(double x, double y, Anchor anchor, std::string_view text, std::string_view classes) {
  const char* at = anchor == Anchor::kStart    ? ""
                   : anchor == Anchor::kMiddle ? " text-anchor=\"middle\""
                                               : " text-anchor=\"end\"";
  content_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\"{}>{}</text>", classes,
                          Coordinate(x), Coordinate(y), at, Escaped(text));
}

}  // namespace tcs::report
