#include "coordinator/report/replay_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coordinator/report/page_files.h"
#include "coordinator/report/paths_figure.h"
#include "coordinator/report/text.h"

namespace tcs::report {
namespace {

constexpr std::size_t kMostNamed = 4, kMostStaticLines = 40;

const Replay* FirstWithMoments(const std::vector<Replay>& replays) {
  const auto found = std::find_if(replays.begin(), replays.end(),
                                  [](const Replay& replay) { return !replay.time_s.empty(); });
  return found == replays.end() ? nullptr : &*found;
}

double WayOf(const PoseTrack& track) {
  double way = 0;
  for (std::size_t i = 1; i < track.poses.size(); ++i) {
    const PoseRow &a = track.poses[i - 1], &b = track.poses[i];
    way += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  }
  return way;
}

// "predator went 31.2 m and prey 40.0 m", of many robots those that went least and most.
std::string WaysIn(const Replay& replay) {
  struct Went {
    double way;
    const std::string* name;
  };
  std::vector<Went> went;
  for (const RobotTracks& robot : replay.robots) {
    double way = 0;
    for (const std::size_t path : robot.paths) way = std::max(way, WayOf(replay.tracks[path]));
    went.push_back({way, &robot.name});
  }
  if (went.size() > kMostNamed) {
    const auto [least, most] = std::minmax_element(
        went.begin(), went.end(), [](const Went& a, const Went& b) { return a.way < b.way; });
    return fmt::format("of {} robots {} went furthest, {}, and {} least, {}", went.size(),
                       *most->name, Metres(most->way), *least->name, Metres(least->way));
  }
  std::vector<std::string> ways;
  for (const Went& one : went) {
    const bool stood = one.way < 1e-6;
    ways.push_back(stood ? *one.name + " stood still"
                         : fmt::format("{} went {}", *one.name, Metres(one.way)));
  }
  return Listed(ways);
}

std::string SectionHtml(std::string_view id, std::string_view heading, const std::string& sentence,
                        const std::string& html) {
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n<p class=\"says\">{}</p>\n{}</section>\n",
                     id, heading, Escaped(sentence), html);
}

}  // namespace

std::string WorldSection(const std::vector<Replay>& replays) {
  if (replays.empty()) return {};
  std::string data;
  for (const Replay& replay : replays) {
    if (replay.time_s.empty() && replay.said.empty()) continue;
    data += fmt::format("<script type=\"application/json\" class=\"replay\">{}</script>\n",
                        Encoded(replay));
  }
  const Replay* shown = FirstWithMoments(replays);
  if (shown == nullptr) {
    return SectionHtml(
        "world", "The world",
        "There is none to show: the scenario has no bodies and no models, or the run "
        "did not write where they were (bodies.csv).",
        data);
  }
  std::string of;
  if (shown->trials > 1) of = fmt::format("The first of {} trials: ", shown->trials);
  if (replays.size() > 1) {
    of = Quoted(shown->name) +
         (shown->trials > 1 ? fmt::format(", the first of {} trials: ", shown->trials) : ": ");
  }
  return SectionHtml(
      "world", "The world",
      fmt::format("{}{} of virtual time, in which {}.", of, Seconds(shown->end_s), WaysIn(*shown)),
      std::string(kReplayHtml) + data);
}

std::optional<Figure> PathsFigure(const std::vector<Replay>& replays) {
  const Replay* shown = FirstWithMoments(replays);
  if (shown == nullptr || shown->robots.empty()) return {};
  return MakeFigure("paths", "Where the robots went",
                    "Their ways from above and from the side; the dot is where each is at the time "
                    "shown, or at the end.",
                    "Lengths are to one scale. A model that stands on the world is drawn by those "
                    "of its links that move.",
                    [&](int width) { return DrawPaths(*shown, width); });
}

std::optional<Figure> MotionFigure(const std::vector<Replay>& replays) {
  const Replay* shown = FirstWithMoments(replays);
  if (shown == nullptr || shown->robots.empty()) return {};
  return MakeFigure("motion", "What a robot did over time",
                    "Its position, orientation and velocity, its joints, and what was commanded: a "
                    "command holds until the next one.",
                    "A click or a drag moves the world to that time. Dashed lines are marks: lines "
                    "that a program wrote and that begin with “mark:”.",
                    [&](int width) { return DrawMotion(*shown, width); });
}

std::string SaidSection(const std::vector<Replay>& replays) {
  if (replays.empty()) return {};
  const auto talkative = std::find_if(replays.begin(), replays.end(),
                                      [](const Replay& replay) { return !replay.said.empty(); });
  if (talkative == replays.end()) {
    return SectionHtml(
        "said", "What programs said",
        "Nothing: no program wrote to its standard output or error, or the run did not "
        "note when (output.csv).",
        "");
  }
  const std::vector<Said>& said = talkative->said;
  std::string items;
  for (std::size_t i = 0; i < std::min(said.size(), kMostStaticLines); ++i) {
    const Said& line = said[i];
    items += fmt::format(
        "<li><span class=\"time\">{:.3f}\u00a0s</span><span class=\"who\">{}</span><span "
        "class=\"text {}\">{}</span></li>\n",
        static_cast<double>(line.time_us) * 1e-6, Escaped(line.client),
        line.is_mark ? "mark" : line.stream, Escaped(line.text));
  }
  const auto marks =
      std::count_if(said.begin(), said.end(), [](const Said& line) { return line.is_mark; });
  std::string sentence =
      fmt::format("{} in virtual time, each from when it was in the program's log",
                  Count(static_cast<std::int64_t>(said.size()), "line"));
  if (marks > 0) sentence += fmt::format("; {} of them are marks", marks);
  if (talkative->said_more > 0) {
    sentence += fmt::format("; {} more are in the logs alone", Grouped(talkative->said_more));
  }
  return SectionHtml("said", "What programs said", sentence + ".",
                     "<div class=\"controls\" hidden><label>of <select></select></label></div>\n"
                     "<ol id=\"said-lines\" tabindex=\"0\" aria-label=\"What programs said\">\n" +
                         items + "</ol>\n");
}

}  // namespace tcs::report
