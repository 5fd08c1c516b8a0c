// The page's own style and script, as text: report/page/. And three.js.
#pragma once

#include <string_view>

namespace tcs::report {

extern const std::string_view kReportCss;
extern const std::string_view kTimelineControls;
extern const std::string_view kReplayHtml;
extern const std::string_view kPathsLive;
extern const std::string_view kMotionControls;
extern const std::string_view kThreeJs;
extern const std::string_view kReplayDataJs;
// The parts for a run that goes on.
extern const std::string_view kLiveHtml;
extern const std::string_view kLiveJs;
// All other scripts of any page, in the order in which they run.
extern const std::string_view kPageJs;

}  // namespace tcs::report
