#include "coordinator/report/figure.h"

#include <fmt/format.h>

#include <utility>

#include "coordinator/report/style.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

// The text alternative: what the figure is, and what it shows.
std::string Described(const Figure& figure, const std::string& variant) {
  return fmt::format("<title id=\"{0}-{1}-title\">{2}</title><desc id=\"{0}-{1}-desc\">{3}</desc>",
                     figure.id, variant, Escaped(figure.title), Escaped(figure.sentence));
}

std::string Opening(const Figure& figure, const Drawing& drawing, const std::string& variant,
                    const std::string& attributes) {
  return fmt::format(
      "<svg {0} viewBox=\"0 0 {1} {2}\" width=\"{1}\" height=\"{2}\" role=\"img\" "
      "aria-labelledby=\"{3}-{4}-title {3}-{4}-desc\">",
      attributes, drawing.width, drawing.height, figure.id, variant);
}

}  // namespace

Figure MakeFigure(std::string id, std::string title, std::string sentence, std::string note,
                  const std::function<Drawing(int width)>& draw) {
  return {std::move(id),   std::move(title), std::move(sentence),
          std::move(note), draw(kWideWidth), draw(kNarrowWidth)};
}

std::string StandaloneSvg(const Figure& figure) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}{}<style>{}</style>"
      "<rect width=\"100%\" height=\"100%\" style=\"fill:#fff\"/>{}</svg>\n",
      Opening(figure, figure.wide, "alone", "xmlns=\"http://www.w3.org/2000/svg\""),
      Described(figure, "alone"), StandaloneStyle(), figure.wide.content);
}

std::string InlineSvg(const Figure& figure, const Drawing& drawing, const std::string& variant) {
  return Opening(figure, drawing, variant, fmt::format("class=\"{}\"", variant)) +
         Described(figure, variant) + drawing.content + "</svg>";
}

}  // namespace tcs::report
