#include "coordinator/report/svg.h"

#include <gtest/gtest.h>

#include "coordinator/report/figure.h"

namespace tcs::report {
namespace {

TEST(Svg, CoordinatesHaveNoMoreDigitsThanOneSees) {
  EXPECT_EQ(Coordinate(12.0), "12");
  EXPECT_EQ(Coordinate(12.34), "12.3");
  EXPECT_EQ(Coordinate(-0.04), "0");
  EXPECT_EQ(Coordinate(-0.26), "-.3");
}

TEST(Svg, APathIsRelativeAndItsRoundingDoesNotAddUp) {
  EXPECT_EQ(PathThrough({{10, 20}, {11, 20.5}, {10.5, 20.5}}), "M10 20l1 .5-.5 0");
  Svg::Points points;
  for (int i = 0; i <= 100; ++i) points.emplace_back(i * 0.04, 0);
  double x = 0;
  for (const auto& step : {PathThrough(points)}) {
    // Forty steps of a tenth and nothing for those that are too small to see.
    for (std::size_t at = step.find(".1 0"); at != std::string::npos;
         at = step.find(".1 0", at + 1)) {
      x += 0.1;
    }
  }
  EXPECT_NEAR(x, 4.0, 1e-9);
}

TEST(Svg, ALineOfOnePointIsNone) {
  Svg svg;
  svg.Polyline({{1, 2}}, "line");
  svg.Area({}, 10, "fill");
  EXPECT_EQ(svg.Take(), "");
}

TEST(Svg, ANameIsNoMarkup) {
  Svg svg;
  svg.Text(0, 0, Svg::Anchor::kStart, "<b>&", "name");
  EXPECT_NE(svg.Take().find(">&lt;b&gt;&amp;</text>"), std::string::npos);
}

TEST(Svg, AFigureAloneHasATextAlternative) {
  const Figure figure = MakeFigure("x", "A & B", "It is <so>.", "", [](int width) {
    return Drawing{width, 10, ""};
  });
  const std::string svg = StandaloneSvg(figure);
  EXPECT_NE(svg.find("role=\"img\""), std::string::npos);
  EXPECT_NE(svg.find("<title id=\"x-alone-title\">A &amp; B</title>"), std::string::npos);
  EXPECT_NE(svg.find("It is &lt;so&gt;.</desc>"), std::string::npos);
  EXPECT_EQ(svg.find("var("), std::string::npos) << "not all programs know variables";
}

}  // namespace
}  // namespace tcs::report
