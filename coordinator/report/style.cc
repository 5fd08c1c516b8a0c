#include "coordinator/report/style.h"

#include <fmt/format.h>

#include <string_view>

namespace tcs::report {

namespace {

struct Colour {
  std::string_view name, light, dark;
};

// Any two series differ by at least 0.11 in Oklab, also as people see them who lack one kind of
// cone, and each has a contrast of 4.5 to the paper, so that it can be a text's colour. Found by
// search, from the first two of Okabe and Ito's palette.
constexpr Colour kColours[] = {
    {"paper", "#ffffff", "#14171a"}, {"ink", "#1b1f23", "#e4e7ea"},
    {"faint", "#59636e", "#9aa4ae"}, {"grid", "#e6e9ec", "#2a2f35"},
    {"panel", "#f6f7f8", "#1c2024"}, {"link", "#005a9c", "#6cb8ff"},
    {"stage", "#eef1f4", "#0e1114"}, {"force", "#c4003a", "#ff6f91"},
    {"s0", "#b84e00", "#ff9d5c"},    {"s1", "#0072b2", "#5cb8f0"},
    {"s2", "#b02dff", "#32f1c1"},    {"s3", "#630a32", "#ff1389"},
    {"s4", "#795869", "#a16cff"},    {"s5", "#1800d1", "#ffd830"},
    {"s6", "#3d2272", "#aa7500"},    {"s7", "#901b00", "#0591aa"},
};

// {…} is a colour.
constexpr std::string_view kRules = R"(
text{font:12px system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif;fill:{ink};paint-order:stroke;stroke:{paper};stroke-width:3px;stroke-linejoin:round}
text.tick,text.note{fill:{faint}}
text.name{font-weight:600}
path,rect,circle{fill:none;stroke:none}
path.grid{stroke:{grid};stroke-width:1}
path.axis{stroke:{faint};stroke-width:1}
path.mark{stroke:{ink};stroke-width:1;stroke-dasharray:4 3}
path.thin{stroke-width:1;stroke-opacity:.45;stroke-linejoin:round}
path.line{stroke-width:1.5;stroke-linejoin:round}
path.bold{stroke-width:2.5;stroke-linejoin:round;stroke-linecap:round}
path.halo{stroke:{paper};stroke-width:5;stroke-linejoin:round}
.band{fill-opacity:.16}
.fill{fill-opacity:.3}
.dot{fill-opacity:.7}
path.busy{fill:{ink};fill-opacity:.75}
rect.lane{fill:{panel}}
path.progress{stroke:{s1};stroke-width:1.5}
path.miss{stroke:{force};stroke-width:1.5}
path.miss.is-chosen{stroke-width:3.5}
path.deadline{stroke:{force};stroke-width:1.5;stroke-dasharray:5 3}
path.cursor{stroke:{link};stroke-width:1.5}
path.said{fill:{faint}}
path.said.is-mark{fill:{s0}}
circle.now{stroke:{paper};stroke-width:1.5;cursor:pointer}
g.is-lit text.note{fill:{ink};font-weight:600}
g.is-lit rect.lane{fill:{link};fill-opacity:.16}
g.is-lit path.busy{fill:{link}}
)";

std::string WithColours(std::string_view rules, bool as_variables) {
  std::string text(rules);
  for (const Colour& colour : kColours) {
    const std::string token = fmt::format("{{{}}}", colour.name);
    const std::string value =
        as_variables ? fmt::format("var(--{})", colour.name) : std::string(colour.light);
    for (std::size_t at = text.find(token); at != std::string::npos; at = text.find(token, at)) {
      text.replace(at, token.size(), value);
    }
  }
  return text;
}

std::string Rules(bool as_variables) {
  std::string rules(kRules);
  for (int i = 0; i < kSeriesColours; ++i) {
    rules += fmt::format(
        ".s{0}{{stroke:{{s{0}}}}}.f{0}{{fill:{{s{0}}}}}text.t{0},tspan.t{0}{{fill:{{s{0}}}}}\n", i);
  }
  return WithColours(rules, as_variables);
}

}  // namespace

std::string StandaloneStyle() {
  return WithColours("svg{background:{paper}}", false) + Rules(false);
}

std::string PageStyle() {
  std::string light, dark;
  for (const Colour& colour : kColours) {
    light += fmt::format("--{}:{};", colour.name, colour.light);
    dark += fmt::format("--{}:{};", colour.name, colour.dark);
  }
  return fmt::format(
      ":root{{color-scheme:light dark;{}}}\n"
      "@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}\n{}",
      light, dark, Rules(true));
}

std::string SeriesClass(char kind, int series) {
  return fmt::format("{}{}", kind, series % kSeriesColours);
}

}  // namespace tcs::report
