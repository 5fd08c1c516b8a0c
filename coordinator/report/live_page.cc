#include "coordinator/report/live_page.h"

#include <fmt/format.h>

#include <string_view>

#include "coordinator/report/bytes.h"
#include "coordinator/report/page_files.h"
#include "coordinator/report/style.h"
#include "coordinator/report/text.h"

namespace tcs::report {

namespace {

std::string LiveSection(std::string_view id, std::string_view heading, std::string_view sentence,
                        const std::string& html) {
  return fmt::format("<section{}>\n<h2>{}</h2>\n<p class=\"says\">{}</p>\n{}</section>\n",
                     id.empty() ? "" : fmt::format(" id=\"{}\"", id), heading, sentence, html);
}

std::string LiveFigure(std::string_view id, std::string_view content) {
  return fmt::format("<figure id=\"{}\">\n{}</figure>\n", id, content);
}

std::string Data(std::string_view kind, const nlohmann::ordered_json& json) {
  return fmt::format("<script type=\"application/json\" class=\"{}\">{}</script>\n", kind,
                     ForScript(json));
}

std::string Sections(const nlohmann::ordered_json& news) {
  if (!news.contains("replay") || news["to"]["moments"] == 0) return {};
  return LiveSection("world", "The world", "As far as the run has come.",
                     std::string(kReplayHtml) + Data("replay", news["replay"])) +
         LiveSection("", "Where the robots went",
                     "From above and from the side; the dot is where each is.",
                     LiveFigure("paths", kPathsLive)) +
         LiveSection(
             "", "What a robot did over time",
             "Its position, orientation and velocity, its joints, and what was commanded: a "
             "command holds until "
             "the next one. A click or a drag moves the world to that time.",
             LiveFigure("motion", kMotionControls)) +
         LiveSection(
             "said", "What programs said", "Each line from when it was in the program's log.",
             "<div class=\"controls\" hidden><label>of <select></select></label></div>\n"
             "<ol id=\"said-lines\" tabindex=\"0\" aria-label=\"What programs said\"></ol>\n") +
         LiveSection("", "Who ran when",
                     "The more of a column is filled, the more of that time the program ran.",
                     LiveFigure("timeline", std::string(kTimelineControls) +
                                                Data("timeline", news["timeline"])));
}

}  // namespace

std::string LivePage(const LivePageOptions& options, const nlohmann::ordered_json& news) {
  nlohmann::ordered_json about{
      {"generation", news["generation"]}, {"to", news["to"]}, {"mayControl", options.may_control}};
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>\n{1}{2}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n{3}{4}</"
      "main>\n{5}"
      "<script>\n{6}</script>\n<script>\n{7}</script>\n<script>\n{8}{9}</script>\n</body>\n</"
      "html>\n",
      Escaped(options.title), PageStyle(), kReportCss, kLiveHtml, Sections(news),
      Data("live", about), kThreeJs, kReplayDataJs, kPageJs, kLiveJs);
}

}  // namespace tcs::report
