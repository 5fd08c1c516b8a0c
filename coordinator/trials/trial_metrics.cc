#include "coordinator/trials/trial_metrics.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "coordinator/os/files.h"
#include "coordinator/trials/outcome.h"

namespace tcs {

std::string NoteTrialMetrics(const std::string& folder, const std::vector<std::string>& trials) {
  using Json = nlohmann::ordered_json;
  std::vector<std::string> sorted = trials;
  std::ranges::sort(sorted);
  Json metrics = Json::object();
  for (const std::string& trial : sorted) {
    const Json summary =
        Json::parse(ReadText(folder + "/" + trial + "/summary.json"), nullptr, false);
    if (!summary.is_object() || !summary.contains("metrics")) continue;
    const Json& its = summary["metrics"];
    if (its.is_object() && !its.empty()) metrics[trial] = its;
  }
  if (metrics.empty()) return {};
  const std::string path = folder + "/trials.json";
  Json record = Json::parse(ReadText(path), nullptr, false);
  if (!record.is_object()) return {};  // somebody has changed it meanwhile; their file stays
  record["metrics"] = std::move(metrics);
  return WriteWhole(path, record.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace tcs
