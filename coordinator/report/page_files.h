// The page's own style and script, as text: report/page/.
#pragma once

#include <string_view>

namespace tcs::report {

extern const std::string_view kReportCss;
extern const std::string_view kTimelineControls;
extern const std::string_view kTimelineJs;

}  // namespace tcs::report
