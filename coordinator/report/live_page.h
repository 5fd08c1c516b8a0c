// The page of a run that goes on: the parts of the report's page that show what happens, which ask
// the server for what is new, and the controls of the run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tcs::report {

struct LivePageOptions {
  std::string title;
  bool may_control = false;  // the run looks at what the page asks of it
};

// `news` is all that there is so far (LiveRun::NewsSince). Without moments the page only waits for
// them.
[[nodiscard]] std::string LivePage(const LivePageOptions& options,
                                   const nlohmann::ordered_json& news);

}  // namespace tcs::report
