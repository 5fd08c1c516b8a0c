// A figure of the report: a picture drawn for wide and for narrow screens, and the words about it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "coordinator/report/svg.h"

namespace tcs::report {

inline constexpr int kWideWidth = 760, kNarrowWidth = 360;

struct Figure {
  std::string id;        // a file's name, and an anchor of the page
  std::string title;     // plain text, as all below
  std::string sentence;  // what the figure shows, computed from the data
  std::string note;      // how to read the figure; may be empty
  Drawing wide, narrow;
};

// Draws the figure at both widths.
[[nodiscard]] Figure MakeFigure(std::string id, std::string title, std::string sentence,
                                std::string note, const std::function<Drawing(int width)>& draw);

// The picture as an SVG document of its own.
[[nodiscard]] std::string StandaloneSvg(const Figure& figure);

// The picture as a part of a page; `variant` tells the two pictures of one figure apart.
[[nodiscard]] std::string InlineSvg(const Figure& figure, const Drawing& drawing,
                                    const std::string& variant);

}  // namespace tcs::report
