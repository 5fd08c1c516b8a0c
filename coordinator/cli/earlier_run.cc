#include "coordinator/cli/earlier_run.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <system_error>

#include "coordinator/text/csv.h"

namespace tcs {

void RemoveLogsOfEarlierRun(const std::string& folder, const Scenario& scenario) {
  std::set<std::string> ours;
  for (const RobotSpec& robot : scenario.robots) {
    for (const ClientSpec& client : robot.clients) ours.insert(FileNameOf(client));
  }
  for (const char* of : {"/summary.json", "/unfinished.json"}) {
    const std::optional<std::string> text = ReadFile(folder + of);
    const nlohmann::json summary = nlohmann::json::parse(text.value_or(""), nullptr, false);
    if (!summary.is_object() || !summary.contains("clients")) continue;
    for (const auto& [name, client] : summary["clients"].items()) {
      std::string base = name;
      std::ranges::replace(base, '/', '-');
      // A client's name is two names with a slash between: any other name is no file of ours.
      if (std::ranges::count(name, '/') != 1 || name.find("..") != std::string::npos) continue;
      if (ours.contains(base)) continue;
      std::error_code ignored;
      for (const char* log : {".out.log", ".err.log"})
        std::filesystem::remove(folder + "/" + base + log, ignored);
    }
  }
}

}  // namespace tcs
