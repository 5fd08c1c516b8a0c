// Names of figures as people give them.
#pragma once

#include <string>
#include <vector>

namespace tcs::compare {

// "lap_time" means all figures of that metric or client, "lap_time.last" one of these figures,
// "response_p50" that of all clients; a robot's name may be left out.
[[nodiscard]] bool NameMeans(const std::string& wanted, const std::string& figure);

// True if one of the `wanted` names means `figure`.
[[nodiscard]] bool IsAmong(const std::string& figure, const std::vector<std::string>& wanted);

}  // namespace tcs::compare
